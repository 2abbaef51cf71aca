// SPDX-License-Identifier: Apache-2.0
// What viewer/film.mjs asks of the page: the picture alone at a time, the camera turned about the middle.
import type { Player } from "./player";
import type { View } from "./view";

export interface Film {
  begin(): { begin: number; end: number };
  show(t: number, degrees: number): void;
  pixels(): { width: number; height: number; rgba: string };
  png(): string;
}

export function film(view: View, player: Player, app: HTMLElement): Film {
  const { stage } = view, canvas = stage.renderer.domElement;
  let turned = 0;
  return {
    begin() {
      app.classList.add("film");
      if (stage.looking) stage.view(stage.looking); else stage.resize();
      stage.looking = null;
      return { begin: player.begin, end: player.end };
    },
    show(t, degrees) {
      const { camera, controls } = stage;
      camera.position.sub(controls.target).applyAxisAngle(stage.up, (degrees - turned) * Math.PI / 180).add(controls.target);
      turned = degrees;
      controls.update();
      player.seek(t);
      stage.draw();
    },
    pixels() {
      const flat = document.createElement("canvas"), context = flat.getContext("2d") as CanvasRenderingContext2D;
      flat.width = canvas.width;
      flat.height = canvas.height;
      context.drawImage(canvas, 0, 0);
      const data = context.getImageData(0, 0, flat.width, flat.height).data;
      let text = "";
      for (let i = 0; i < data.length; i += 32768) text += String.fromCharCode(...data.subarray(i, i + 32768));
      return { width: flat.width, height: flat.height, rgba: btoa(text) };
    },
    png: () => canvas.toDataURL("image/png"),
  };
}
