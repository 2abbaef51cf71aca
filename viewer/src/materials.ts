// SPDX-License-Identifier: Apache-2.0
// Shading of surfaces, and rendering effort by the machine.
import { MeshLambertMaterial, MeshStandardMaterial, type MeshStandardMaterialParameters } from "three";

/** Whether rendering is in software: then the effects that cost most per pixel are off. */
export const software = ((): boolean => {
  const context = document.createElement("canvas").getContext("webgl2"), names = context?.getExtension("WEBGL_debug_renderer_info");
  const name = context && names ? String(context.getParameter(names.UNMASKED_RENDERER_WEBGL)) : "";
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
})();

export type Surface = MeshStandardMaterial | MeshLambertMaterial;

export function surface(parameters: MeshStandardMaterialParameters): Surface {
  if (!software) return new MeshStandardMaterial(parameters);
  const { roughness: _r, metalness: _m, ...rest } = parameters;
  return new MeshLambertMaterial(rest);
}
