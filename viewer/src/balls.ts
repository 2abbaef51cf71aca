// SPDX-License-Identifier: Apache-2.0
// Balls as discs that face the camera and are shaded as balls: two triangles each instead of hundreds, so that thousands can be drawn without a graphics processor.
import { outlineOf, outlines } from "./edges";
import { InstancedMesh, MeshLambertMaterial, PlaneGeometry, Sphere, Vector3 } from "three";

const kVertexHead = `#include <common>
varying vec3 vBallCentre, vBallAt;
varying vec4 vBallDepth;
uniform float ballRadius;`;

// The disc is as large as the outline of the ball: larger than its section, by perspective.
const kVertex = `
mat4 ballMatrix = modelViewMatrix * instanceMatrix;
vec4 mvPosition = vec4(ballMatrix[3].xyz, 1.0);
vBallCentre = mvPosition.xyz;
float ballFar = length(mvPosition.xyz), ballSize = ballRadius * length(ballMatrix[0].xyz);
vec3 ballEye = isOrthographic ? vec3(0.0, 0.0, 1.0) : -mvPosition.xyz / ballFar;
vec3 ballSide = normalize(cross(abs(ballEye.y) > 0.9 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0), ballEye));
float ballGrow = isOrthographic ? 1.0 : ballFar / sqrt(max(ballFar * ballFar - ballSize * ballSize, 1e-4 * ballFar * ballFar));
mvPosition.xyz += ballGrow * ballSize * (position.x * ballSide + position.y * cross(ballEye, ballSide));
vBallAt = mvPosition.xyz;
vBallDepth = vec4(projectionMatrix[2][2], projectionMatrix[3][2], projectionMatrix[2][3], projectionMatrix[3][3]);
gl_Position = projectionMatrix * mvPosition;`;

const kFragmentHead = `#include <common>
varying vec3 vBallCentre, vBallAt;
varying vec4 vBallDepth;
uniform float ballRadius, outlines;`;

// Intersection of the ray through this pixel with the ball, in the camera's frame.
const kFragment = `
float faceDirection = 1.0;
vec3 ballFrom = isOrthographic ? vec3(vBallAt.xy, 0.0) : vec3(0.0), ballWay = isOrthographic ? vec3(0.0, 0.0, -1.0) : normalize(vBallAt);
vec3 ballTo = ballFrom - vBallCentre;
float ballAlong = dot(ballTo, ballWay), ballRoot = ballAlong * ballAlong - dot(ballTo, ballTo) + ballRadius * ballRadius;
float outlineAt = sqrt(max(0.0, dot(ballTo, ballTo) - ballAlong * ballAlong)) / ballRadius, outlineLight = ${outlineOf("outlineAt")};
if (ballRoot < 0.0) discard;
vec3 ballHit = ballFrom - (ballAlong + sqrt(ballRoot)) * ballWay, normal = (ballHit - vBallCentre) / ballRadius, nonPerturbedNormal = normal;
gl_FragDepth = 0.5 + 0.5 * (vBallDepth.x * ballHit.z + vBallDepth.y) / (vBallDepth.z * ballHit.z + vBallDepth.w);`;

/** Discs for the balls of a mesh, which share its places and colours. */
export function discsFor(balls: InstancedMesh): InstancedMesh {
  balls.geometry.computeBoundingSphere();
  const radius = (balls.geometry.boundingSphere ?? new Sphere(new Vector3(), 1)).radius, material = new MeshLambertMaterial();
  material.onBeforeCompile = (shader) => {
    shader.uniforms.ballRadius = { value: radius };
    shader.uniforms.outlines = outlines;
    shader.vertexShader = shader.vertexShader.replace("#include <common>", kVertexHead).replace("#include <project_vertex>", kVertex);
    shader.fragmentShader = shader.fragmentShader.replace("#include <common>", kFragmentHead).replace("#include <normal_fragment_begin>", kFragment)
      .replace("#include <opaque_fragment>", "outgoingLight *= outlineLight;\n#include <opaque_fragment>");
  };
  const discs = new InstancedMesh(new PlaneGeometry(2, 2), material, balls.count);
  discs.instanceMatrix = balls.instanceMatrix;
  discs.frustumCulled = false;
  discs.raycast = () => undefined;  // picking uses the balls themselves
  return discs;
}
