// SPDX-License-Identifier: Apache-2.0
// How surfaces are shaded, and how much a machine can draw.
import { MeshLambertMaterial, MeshStandardMaterial, type MeshStandardMaterialParameters } from "three";

/** Whether pictures are computed without a graphics processor: then what costs most for each pixel is left out. */
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
