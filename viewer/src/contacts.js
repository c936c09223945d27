// Contacts: discs as large as the surface that belongs to them, with an arrow from the scene to the object.
import { CircleGeometry, ConeGeometry, CylinderGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial, Quaternion, RingGeometry, Vector3 } from 'three';
import { ARROW, scale } from './colors.js';

const FORWARD = new Vector3(0, 0, 1);
const UPWARD = new Vector3(0, 1, 0);
// Of unit size, shared by all.
const DISC = new CircleGeometry(1, 48);
const RIM = new RingGeometry(0.94, 1, 48);
const SHAFT = new CylinderGeometry(0.03, 0.03, 0.8, 12).translate(0, 0.4, 0);
const HEAD = new ConeGeometry(0.1, 0.25, 16).translate(0, 0.875, 0);
// Transparent as the discs are, or these would be drawn after the arrows.
const BLACK = new MeshBasicMaterial({ color: ARROW, depthTest: false, transparent: true });

// `origin` is subtracted from all places; `length` of the arrows in metres.
export function drawContacts(contacts, origin, length) {
  const group = new Group();
  // The likeliest last, on top of the others.
  for (const { point, normal, probability, radius } of [...contacts].reverse()) {
    const place = new Group();
    const direction = new Vector3(...normal);
    place.position.set(...point).sub(origin);
    const color = scale(probability);
    for (const [geometry, opacity] of [[DISC, 0.4], [RIM, 0.9]]) {
      const look = { color, side: DoubleSide, transparent: true, opacity, depthTest: false };
      const disc = new Mesh(geometry, new MeshBasicMaterial(look));
      disc.quaternion.copy(new Quaternion().setFromUnitVectors(FORWARD, direction));
      disc.scale.setScalar(Math.max(radius ?? 0, 0.12 * length));
      disc.renderOrder = 2;
      place.add(disc);
    }
    for (const geometry of [SHAFT, HEAD]) {
      const part = new Mesh(geometry, BLACK);
      part.quaternion.copy(new Quaternion().setFromUnitVectors(UPWARD, direction));
      part.scale.setScalar(length);
      part.renderOrder = 3;
      place.add(part);
    }
    group.add(place);
  }
  return group;
}
