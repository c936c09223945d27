// Depth made visible: a place that lies behind its neighbours gets darker (eye-dome lighting, Boucheny 2009),
// so that points without normals read as surfaces.
import { DepthTexture, HalfFloatType, Mesh, OrthographicCamera, PlaneGeometry, Scene, ShaderMaterial, Vector2, WebGLRenderTarget } from 'three';

const VERTEX = /* glsl */ `
  varying vec2 at;
  void main() {
    at = uv;
    gl_Position = vec4(position.xy, 0.0, 1.0);
  }`;

const FRAGMENT = /* glsl */ `
  uniform sampler2D color, depth;
  uniform vec2 reach;
  uniform float near, far;
  varying vec2 at;
  float logDistance(vec2 place) {
    float z = texture2D(depth, place).x;
    return log2(near * far / (far - z * (far - near)));
  }
  void main() {
    float here = logDistance(at), behind = 0.0;
    for (int i = 0; i < 8; i++) {
      float angle = 0.785398 * float(i);
      behind += clamp(here - logDistance(at + reach * vec2(cos(angle), sin(angle))), 0.0, 0.08);
    }
    gl_FragColor = vec4(texture2D(color, at).rgb * exp(-2.2 * behind), 1.0);
    #include <colorspace_fragment>
  }`;

export class Shade {
  constructor() {
    this.target = new WebGLRenderTarget(1, 1, { type: HalfFloatType, samples: 4, depthTexture: new DepthTexture(1, 1) });
    const uniforms = {
      color: { value: this.target.texture },
      depth: { value: this.target.depthTexture },
      reach: { value: new Vector2() },
      near: { value: 1 },
      far: { value: 2 },
    };
    this.material = new ShaderMaterial({ uniforms, vertexShader: VERTEX, fragmentShader: FRAGMENT, depthTest: false });
    this.scene = new Scene().add(new Mesh(new PlaneGeometry(2, 2), this.material));
    this.camera = new OrthographicCamera();
  }

  render(renderer, scene, camera) {
    const { width, height } = renderer.domElement;
    this.target.setSize(width, height);
    renderer.setRenderTarget(this.target);
    renderer.render(scene, camera);
    renderer.setRenderTarget(null);
    const { reach, near, far } = this.material.uniforms;
    const pixels = 1.5 * renderer.getPixelRatio();
    reach.value.set(pixels / width, pixels / height);
    near.value = camera.near;
    far.value = camera.far;
    renderer.render(this.scene, this.camera);
  }
}
