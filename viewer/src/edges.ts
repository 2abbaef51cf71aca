// SPDX-License-Identifier: Apache-2.0
// Edges of bodies as lines, and dark outlines of round ones.
import { type BufferGeometry, type Color, EdgesGeometry, type InstancedBufferAttribute, type InstancedMesh, LineBasicMaterial, LineSegments } from "three";
import { software, type Surface } from "./materials";

/** Most lines of all instances of a mesh: beyond them a picture of edges alone would be slow, and black. */
const kMost = software ? 20000 : 1000000;
/** Most triangles of a mesh whose edges are looked for: that takes time at the start. */
const kMostTriangles = 60000;

/** Lines that are drawn for each instance of a mesh; the renderer asks for no more than these members. */
class InstancedLines extends LineSegments {
  readonly isInstancedMesh = true;
  readonly instanceColor = null;
  readonly morphTexture = null;
  /** Distance from the eye at which the lines are, relative to that of the edges: above 1 they are behind surfaces at the same place. */
  readonly depth = { value: 1 };
  instanceMatrix: InstancedBufferAttribute;
  count: number;
  constructor(geometry: BufferGeometry, material: LineBasicMaterial, of: InstancedMesh) {
    super(geometry, material);
    this.instanceMatrix = of.instanceMatrix;
    this.count = of.count;
    this.frustumCulled = false;
    this.raycast = () => undefined;
    material.onBeforeCompile = (shader) => {
      shader.uniforms.edgeDepth = this.depth;
      shader.vertexShader = shader.vertexShader.replace("#include <common>", "#include <common>\nuniform float edgeDepth;")
        .replace("#include <project_vertex>", "#include <project_vertex>\nvec4 edgeBehind = projectionMatrix * vec4(mvPosition.xy, edgeDepth * mvPosition.z, 1.0);\ngl_Position.z = edgeBehind.z / edgeBehind.w * gl_Position.w;");
    };
  }
}
export type Edges = InstancedLines;

/** Edges between faces that meet at more than 30 degrees, for all instances; null if there are none, or too many. */
export function edgesFor(mesh: InstancedMesh, shape: BufferGeometry, colour: Color | number, opacity: number): Edges | null {
  if ((shape.index?.count ?? 0) > 3 * kMostTriangles) return null;
  const edges = new EdgesGeometry(shape, 30), lines = edges.getAttribute("position").count / 2;
  if (lines === 0 || lines * mesh.count > kMost) return null;
  return new InstancedLines(edges, new LineBasicMaterial({ color: colour, transparent: true, opacity, depthWrite: false }), mesh);
}

/** Whether outlines are drawn: common to all shaders. */
export const outlines = { value: 1 };

/** Factor of the light within a pixel and a half of an outline, where `at` reaches 1. */
export const outlineOf = (at: string): string => `mix(1.0, 0.4, outlines * smoothstep(1.7, 0.7, (1.0 - ${at}) / max(fwidth(${at}), 1e-6)))`;

/** Gives a material dark outlines where its surface turns away from the eye. Flat faces have none, as their normals do not turn. */
export function outlined(material: Surface): Surface {
  material.onBeforeCompile = (shader) => {
    shader.uniforms.outlines = outlines;
    shader.fragmentShader = shader.fragmentShader.replace("#include <common>", "#include <common>\nuniform float outlines;")
      .replace("#include <opaque_fragment>", `float outlineFacing = dot(normal, geometryViewDir), outlineAt = sqrt(max(0.0, 1.0 - outlineFacing * outlineFacing));
float outlineLight = ${outlineOf("outlineAt")};
outgoingLight *= outlineLight;
diffuseColor.a = max(diffuseColor.a, 1.0 - outlineLight);  // ghosts have opaque outlines
#include <opaque_fragment>`);
  };
  return material;
}
