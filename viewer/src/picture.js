// The picture: two bodies, their contacts, and a camera that goes around them.
import { AmbientLight, Color, DirectionalLight, Fog, Matrix4, PerspectiveCamera, Scene, Sphere, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { Body } from './body.js';
import { BACKGROUND, OBJECT, SCENE } from './colors.js';
import { drawContacts } from './contacts.js';
import { overlay } from './scalebar.js';
import { Shade } from './shade.js';

// From where one looks at first, and which way is up.
const LOOKS = {
  z: { from: [-0.6, -0.9, 1.1], up: [0, 0, 1] },
  camera: { from: [0.35, -0.45, -1], up: [0, -1, 0] },
};

// What is framed fills a little less than the picture.
const MARGIN = 1.2;

export class Picture {
  constructor(container, { bodies }) {
    this.container = container;
    this.data = bodies;
    this.drawn = new Map();
    // Which way is up in each scene that was turned by hand.
    this.turned = new Map();
    this.renderer = new WebGLRenderer({ antialias: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    container.append(this.renderer.domElement);
    this.renderer.autoClear = false;
    this.shade = new Shade();
    this.scene = new Scene();
    this.scene.background = new Color(BACKGROUND);
    this.scene.fog = new Fog(BACKGROUND, 1, 2);
    this.camera = new PerspectiveCamera(40, 1, 0.01, 100);
    this.scene.add(new AmbientLight('white', 1.1), this.camera);
    const light = new DirectionalLight('white', 2.6);
    light.position.set(-0.9, 1, 0.6);
    this.camera.add(light);
    // Over everything: most contacts are hidden within the bodies.
    this.above = new Scene();
    this.isCut = true;
    this.drawScale = overlay(container);
    this.turn('z');
    new ResizeObserver(() => this.resize()).observe(container);
  }

  // Looks upright along z, or as a camera at the origin of the scene.
  turn(upright) {
    this.upright = upright;
    this.camera.up.set(...LOOKS[upright].up);
    this.controls?.dispose();
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener('change', () => this.wish());
  }

  // By hand: it stays so in this scene.
  turnScene(upright) {
    this.turned.set(this.view.scene, upright);
    this.turn(upright);
    this.frame('object', true);
  }

  show(view) {
    this.view = view;
    this.group?.removeFromParent();
    for (const body of this.drawn.values()) body.group.removeFromParent();
    const scene = this.body(view.scene, SCENE);
    const object = this.body(view.object, OBJECT);
    const toScene = new Matrix4().set(...view.pose);
    const [from, to] = [scene.middle.clone().negate(), object.middle];
    object.group.matrix
      .makeTranslation(from.x, from.y, from.z)
      .multiply(toScene)
      .multiply(new Matrix4().makeTranslation(to.x, to.y, to.z));
    object.group.matrixWorldNeedsUpdate = true;
    scene.color(view.likely[0]);
    object.color(view.likely[1]);
    this.group = drawContacts(view.contacts, scene.middle, 0.22 * Math.min(object.radius, scene.radius));
    this.scene.add(scene.group, object.group);
    this.above.add(this.group);
    const box = object.box.clone().applyMatrix4(object.group.matrix);
    this.spheres = {
      object: box.getBoundingSphere(new Sphere()),
      scene: scene.box.clone().union(box).getBoundingSphere(new Sphere()),
    };
    const [contact] = view.contacts;
    if (contact) {
      const center = new Vector3(...contact.point).sub(scene.middle);
      this.spheres.contact = new Sphere(center, 0.45 * object.radius);
    }
    const upright = this.turned.get(view.scene) ?? view.upright;
    if (upright !== this.upright) {
      this.turn(upright);
      this.frame('object', true);
    }
    this.wish();
  }

  // As an object and as a scene a body has different colours.
  body(index, color) {
    const key = `${index} ${color}`;
    if (!this.drawn.has(key)) this.drawn.set(key, new Body(this.data[index], color));
    return this.drawn.get(key);
  }

  // Puts one of the spheres into the middle of the picture, seen from where one looks now, or at first.
  frame(name, anew = false) {
    const { center, radius } = this.spheres[name] ?? this.spheres.object;
    const from = anew
      ? new Vector3(...LOOKS[this.upright].from)
      : this.camera.position.clone().sub(this.controls.target);
    const half = (0.5 * this.camera.fov * Math.PI) / 180;
    const widest = Math.min(half, Math.atan(Math.tan(half) * this.camera.aspect));
    this.controls.target.copy(center);
    this.camera.position.copy(center).addScaledVector(from.normalize(), (MARGIN * radius) / Math.sin(widest));
    this.controls.update();
    this.wish();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.container;
    if (!width || !height) return;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.setSize(width, height, false);
    this.render();
  }

  // How far ahead the object begins, with a little room before it.
  frontOfObject() {
    const { center, radius } = this.spheres.object;
    const ahead = this.camera.getWorldDirection(new Vector3());
    return center.clone().sub(this.camera.position).dot(ahead) - 1.15 * radius;
  }

  // Draws once, soon: nothing moves on its own.
  wish() {
    this.wished ??= requestAnimationFrame(() => {
      this.wished = undefined;
      this.render();
    });
  }

  render() {
    if (!this.view) return;
    const { camera, controls, scene } = this;
    const { center, radius } = this.spheres.scene;
    const distance = camera.position.distanceTo(controls.target);
    const farthest = camera.position.distanceTo(center) + radius;
    camera.near = Math.max(distance / 1000, farthest / 1e5, this.isCut ? this.frontOfObject() : 0);
    camera.far = 1.01 * farthest;
    camera.updateProjectionMatrix();
    scene.fog.near = distance;
    scene.fog.far = Math.max(1.5 * farthest, 2 * distance);
    const height = this.renderer.domElement.height;
    const pixelsPerRadian = (0.5 * height) / Math.tan((camera.fov * Math.PI) / 360);
    scene.traverse(({ material }) => {
      if (material?.uniforms?.pixelsPerRadian) material.uniforms.pixelsPerRadian.value = pixelsPerRadian;
    });
    this.renderer.clear();
    this.shade.render(this.renderer, scene, camera);
    this.renderer.render(this.above, camera);
    this.drawScale(camera, controls.target, this.container.clientHeight);
  }
}
