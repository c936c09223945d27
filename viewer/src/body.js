// A scene or an object: drawn once, and posed as often as one likes.
import { Box3, BufferAttribute, BufferGeometry, DoubleSide, EdgesGeometry, Group, LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial, Sphere, Vector3 } from 'three';
import { bytes, floats, indices } from './decode.js';
import { points, tints } from './points.js';
import { scale } from './colors.js';

// Dots are drawn somewhat larger than their usual distance, so that near surfaces close.
const DOT = 0.6;
// How wide a dot is at least, and that of a single point, which has no distance to others, pixels.
const LEAST = 1.4;
const LEAST_ALONE = 5;

const BEHIND_EDGES = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
// An edge between faces that turn by more is drawn as a line, degrees.
const SHARP = 30;

export class Body {
  constructor({ name, middle, positions, triangles, brightness }, color) {
    this.name = name;
    this.middle = new Vector3(...middle);
    this.positions = floats(positions);
    const attribute = new BufferAttribute(this.positions, 3);
    this.box = new Box3().setFromBufferAttribute(attribute);
    this.radius = this.box.getBoundingSphere(new Sphere()).radius;
    this.group = new Group();
    this.group.matrixAutoUpdate = false;
    this.spacing = spacing(this.box, this.positions.length / 3);
    if (triangles) {
      this.group.add(...surface(attribute, indices(triangles), color));
    } else {
      const light = brightness ? Float32Array.from(bytes(brightness), (b) => b / 255) : this.heights();
      const shades = tints(color, light);
      this.group.add(points(this.positions, shades, { diameter: DOT * this.spacing, least: this.radius > 0 ? LEAST : LEAST_ALONE, most: 7 }));
    }
  }

  // How bright each point is where the file does not tell: less the higher it is, along z.
  heights() {
    const { min, max } = this.box;
    const light = new Float32Array(this.positions.length / 3);
    return light.map((_, i) => 0.85 - (0.4 * (this.positions[3 * i + 2] - min.z)) / (max.z - min.z || 1));
  }

  // Takes the coloured points of another view away.
  plain() {
    if (!this.likely) return;
    this.group.remove(this.likely);
    this.likely.geometry.dispose();
    this.likely.material.dispose();
    this.likely = undefined;
  }

  // Replaces the coloured points.
  color({ points: chosen, probabilities }) {
    this.plain();
    const [at, likely] = [indices(chosen), bytes(probabilities)];
    const positions = new Float32Array(3 * at.length);
    const colors = new Float32Array(3 * at.length);
    at.forEach((index, i) => {
      positions.set(this.positions.subarray(3 * index, 3 * index + 3), 3 * i);
      scale(likely[i] / 255).toArray(colors, 3 * i);
    });
    this.likely = points(positions, colors, { diameter: 1.2 * this.spacing, least: 5, most: 14 });
    this.likely.renderOrder = 1;
    this.group.add(this.likely);
  }
}

function surface(positions, triangles, color) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', positions);
  geometry.setIndex(new BufferAttribute(triangles, 1));
  const flat = geometry.toNonIndexed();
  flat.computeVertexNormals();
  // What lies within must be seen: contacts are on and below the surface.
  const look = { color, side: DoubleSide, transparent: true, opacity: 0.72, ...BEHIND_EDGES };
  const edges = new LineBasicMaterial({ color: '#1c2329', transparent: true, opacity: 0.35 });
  return [
    new Mesh(flat, new MeshLambertMaterial(look)),
    new LineSegments(new EdgesGeometry(geometry, SHARP), edges),
  ];
}

// A guess of how far neighbours are apart: points on the faces of a box.
function spacing(box, count) {
  const { x, y, z } = box.getSize(new Vector3());
  return Math.sqrt((2 * (x * y + y * z + z * x)) / Math.max(count, 1));
}
