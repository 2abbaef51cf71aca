// SPDX-License-Identifier: Apache-2.0
// The shape of each kind of joint.
import { BoxGeometry, BufferGeometry, CylinderGeometry, OctahedronGeometry, SphereGeometry, TorusGeometry } from "three";
import { mergeGeometries } from "three/examples/jsm/utils/BufferGeometryUtils.js";

export const alongZ = (g: BufferGeometry): BufferGeometry => g.rotateX(Math.PI / 2);
export const merged = (...parts: BufferGeometry[]): BufferGeometry => mergeGeometries(parts.map((p) => p.toNonIndexed()));

/** Kinds between two separate points: a rod is drawn between them. */
export const kLinks = ["distance", "revolute_spherical", "universal_spherical", "slack_link"];

/** Shape of a kind of joint in its own axes, of size 1; z is the axis. Generic joints and unknown kinds are octahedra. */
export function jointShape(type: string): BufferGeometry {
  const pin = (r: number, l: number) => alongZ(new CylinderGeometry(r, r, l, 20));
  switch (type) {
    case "revolute": return merged(pin(0.32, 1.3), pin(0.55, 0.3));
    case "prismatic": return merged(new BoxGeometry(0.55, 0.55, 1), new BoxGeometry(0.22, 0.22, 2.6));
    case "cylindrical": return merged(pin(0.5, 1), pin(0.2, 2.6));
    case "spherical": return new SphereGeometry(0.6, 20, 14);
    case "universal": return merged(new CylinderGeometry(0.2, 0.2, 1.7, 14), new CylinderGeometry(0.2, 0.2, 1.7, 14).rotateZ(Math.PI / 2));
    case "constant_velocity": return merged(new SphereGeometry(0.5, 18, 12), new TorusGeometry(0.62, 0.12, 10, 28), pin(0.22, 1.8));
    case "planar": return merged(new BoxGeometry(2.2, 2.2, 0.12), pin(0.15, 0.9));
    case "point_in_plane": return merged(new BoxGeometry(2.2, 2.2, 0.12), new SphereGeometry(0.36, 14, 10));
    case "point_on_line": return merged(pin(0.12, 3), new SphereGeometry(0.42, 14, 10));
    case "parallel_axes": return merged(pin(0.14, 1.8).translate(0.4, 0, 0), pin(0.14, 1.8).translate(-0.4, 0, 0));
    case "fixed": return new BoxGeometry(0.9, 0.9, 0.9);
    case "distance": return new SphereGeometry(0.4, 14, 10);
    case "revolute_spherical": return merged(pin(0.3, 1.1), pin(0.42, 0.24));
    case "universal_spherical": return merged(new CylinderGeometry(0.18, 0.18, 1.2, 14), new CylinderGeometry(0.18, 0.18, 1.2, 14).rotateZ(Math.PI / 2), new SphereGeometry(0.3, 14, 10));
    case "slack_link": return new TorusGeometry(0.45, 0.14, 10, 28);
    default: return new OctahedronGeometry(0.7);
  }
}
