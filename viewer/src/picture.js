// The picture: two bodies that were asked about, others around them, contacts, and a camera that goes around.
import { AmbientLight, Box3, Color, DirectionalLight, Fog, Matrix4, PerspectiveCamera, Scene, Sphere, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { Body } from './body.js';
import { AROUND, BACKGROUND, OBJECT, SCENE } from './colors.js';
import { drawContacts } from './contacts.js';
import { known, sizeOf } from './extent.js';
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
  constructor(container, { bodies, is_one_scene: isOneScene }) {
    this.container = container;
    this.data = bodies;
    this.isOneScene = isOneScene;
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
    this.turned.set(this.sceneOf(this.view), upright);
    this.turn(upright);
    this.frame('object', true);
  }

  show(view) {
    const isOtherScene = this.view && this.sceneOf(this.view) !== this.sceneOf(view);
    this.view = view;
    this.middle = new Vector3(...view.middle);
    this.group?.removeFromParent();
    for (const body of this.drawn.values()) body.group.removeFromParent();
    const around = view.around.map((standing) => this.showOther(standing));
    const pair = view.asked ? this.showPair(view.asked) : { scene: new Box3(), object: known(around) };
    const whole = around.reduce((all, { box }) => all.union(box), pair.scene);
    this.spheres = {
      object: (pair.object.isEmpty() ? whole : pair.object).getBoundingSphere(new Sphere()),
      scene: whole.getBoundingSphere(new Sphere()),
      contact: pair.contact,
    };
    const upright = this.turned.get(this.sceneOf(view)) ?? view.upright;
    const isTurned = upright !== this.upright;
    if (isTurned) this.turn(upright);
    // From where one looks into one scene says nothing of where to look from in another.
    if (isTurned || isOtherScene) this.frame('object', true);
    this.wish();
  }

  // Draws what was not asked about; returns the box around it, and whether it is a cloud.
  showOther(standing) {
    const isCloud = !this.data[standing.body].triangles;
    const color = isCloud ? SCENE : AROUND;
    this.body(standing.body, color).plain();
    return { isCloud, box: this.stand(standing, color) };
  }

  // Draws the two that were asked about; returns the boxes around both, and around the object.
  showPair({ scene, object, likely, contacts }) {
    const boxes = { scene: this.stand(scene, SCENE), object: this.stand(object, OBJECT) };
    const [inScene, moved] = [this.body(scene.body, SCENE), this.body(object.body, OBJECT)];
    inScene.color(likely[0]);
    moved.color(likely[1]);
    const size = sizeOf(moved.radius, inScene.radius);
    this.group = drawContacts(contacts, this.middle, 0.22 * Math.min(size, sizeOf(inScene.radius, size)));
    this.above.add(this.group);
    const [contact] = contacts;
    if (contact) {
      const center = new Vector3(...contact.point).sub(this.middle);
      boxes.contact = new Sphere(center, 0.45 * size);
    }
    boxes.scene = boxes.scene.clone().union(boxes.object);
    return boxes;
  }

  // Draws a body where it stands, and returns the box around it.
  stand({ body: index, pose }, color) {
    const body = this.body(index, color);
    const [from, to] = [this.middle.clone().negate(), body.middle];
    body.group.matrix
      .makeTranslation(from.x, from.y, from.z)
      .multiply(new Matrix4().set(...pose))
      .multiply(new Matrix4().makeTranslation(to.x, to.y, to.z));
    body.group.matrixWorldNeedsUpdate = true;
    this.scene.add(body.group);
    return body.box.clone().applyMatrix4(body.group.matrix);
  }

  // Views of one scene are turned together.
  sceneOf({ asked }) {
    return this.isOneScene ? 0 : asked?.scene.body ?? 0;
  }

  // As an object and as a scene a body has different colours.
  body(index, color) {
    const key = `${index} ${color}`;
    if (!this.drawn.has(key)) this.drawn.set(key, new Body(this.data[index], color));
    return this.drawn.get(key);
  }

  // Puts one of the spheres into the middle of the picture, seen from where one looks now, or at first.
  frame(name, anew = false) {
    const { center, radius: known } = this.spheres[name] ?? this.spheres.object;
    const radius = sizeOf(known, this.spheres.scene.radius);
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
    return center.clone().sub(this.camera.position).dot(ahead) - 1.15 * sizeOf(radius, this.spheres.scene.radius);
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
    // What is far costs depth, but not what one looks at: a stray point may be thousands of kilometres off.
    const near = Math.max(distance / 1000, Math.min(farthest / 1e5, distance / 10));
    camera.near = Math.max(near, this.isCut ? this.frontOfObject() : 0);
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
