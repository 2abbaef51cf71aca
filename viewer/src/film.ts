// SPDX-License-Identifier: Apache-2.0
// A film of the recording for `polhode convert` (apps/polhode/film.cpp): pictures of one size with a camera that rotates
// about the middle, sent to the server of the page.
import { follow } from "./bookmark";
import { gif, type Picture } from "./gif";
import type { Player } from "./player";
import type { View } from "./view";

interface How { kind: "gif" | "png"; width: number; height: number; rate: number; speed: number; turn: number; link: string; from?: number; to?: number }

export const filmWanted = (): boolean => location.protocol !== "file:" && location.search === "?film";

export async function shoot(view: View, player: Player, app: HTMLElement, holder: HTMLElement): Promise<void> {
  const send = async (name: string, body: BodyInit): Promise<void> => {
    if (!(await fetch(`film/${name}`, { method: "POST", body })).ok) throw new Error(`the server did not accept ${name}.`);
  };
  try {
    const how = await (await fetch("film.json")).json() as How, { stage } = view;
    const from = Math.max(player.begin, how.from ?? player.begin), to = Math.min(player.end, how.to ?? player.end);
    if (!(to >= from)) throw new Error(`there are no frames between ${how.from ?? player.begin} and ${how.to ?? player.end} s; the recording goes from ${player.begin} to ${player.end} s`);
    app.classList.add("film");
    stage.renderer?.setPixelRatio(1);
    stage.fixedSize = [how.width, how.height];
    if (stage.looking) stage.view(stage.looking); else stage.resize();
    stage.looking = null;
    if (how.link) follow(how.link, view, player);
    const { canvas } = stage, flat = document.createElement("canvas"), context = flat.getContext("2d", { willReadFrequently: true }) as CanvasRenderingContext2D;
    Object.assign(flat, { width: how.width, height: how.height });
    const count = Math.max(1, Math.round((to - from) / how.speed * how.rate) + 1), pictures: Picture[] = [];
    for (let k = 0, turned = 0; k < count; k++) {
      const part = count > 1 ? k / (count - 1) : 0, angle = part * how.turn, { camera, controls } = stage;
      camera.position.sub(controls.target).applyAxisAngle(stage.up, (angle - turned) * Math.PI / 180).add(controls.target);
      turned = angle;
      controls.update();
      player.seek(from + part * (to - from));
      stage.draw();
      if (stage.renderer?.getContext().isContextLost() ?? true) throw new Error("this browser cannot draw in 3D: WebGL 2 is off, not available, or has stopped; name another Chromium with CHROMIUM");
      context.drawImage(canvas, 0, 0, how.width, how.height);
      if (how.kind === "gif") pictures.push({ width: how.width, height: how.height, rgba: context.getImageData(0, 0, how.width, how.height).data });
      else await send(`${String(k).padStart(5, "0")}.png`, await new Promise<Blob>((resolve, reject) => flat.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("The browser returned no picture."))))));
    }
    if (how.kind === "gif") await send("film.gif", new Blob([gif(pictures, how.rate)]));
    await send("done", "");
    holder.dataset.film = String(count);
  } catch (error) {
    await send("failed", error instanceof Error ? error.message : String(error));
  }
}
