// SPDX-License-Identifier: Apache-2.0
// Shading of surfaces, and rendering effort by the machine.
import { MeshLambertMaterial, MeshStandardMaterial, type MeshStandardMaterialParameters } from "three";

/** Name of the graphics processor, or of the software that stands for it; null without WebGL 2. */
const renderedBy = ((): string | null => {
  const context = document.createElement("canvas").getContext("webgl2"), names = context?.getExtension("WEBGL_debug_renderer_info");
  const name = context && names ? String(context.getParameter(names.UNMASKED_RENDERER_WEBGL)) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return context && name;
})();
/** Whether the browser can draw in 3D. */
export const drawable = renderedBy !== null;
/** Whether rendering is in software: then the effects that cost most per pixel are off. */
export const software = /swiftshader|llvmpipe|softpipe|software|basic render/i.test(renderedBy ?? "");

export type Surface = MeshStandardMaterial | MeshLambertMaterial;

export function surface(parameters: MeshStandardMaterialParameters): Surface {
  if (!software) return new MeshStandardMaterial(parameters);
  const { roughness: _r, metalness: _m, ...rest } = parameters;
  return new MeshLambertMaterial(rest);
}
