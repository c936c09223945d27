// Points as round dots that grow as one comes nearer, and pale with distance as everything does.
import { BufferAttribute, BufferGeometry, Color, Points, ShaderMaterial, UniformsLib, UniformsUtils } from 'three';

const VERTEX = /* glsl */ `
  uniform float diameter, least, most, pixelsPerRadian;
  attribute vec3 tint;
  varying vec3 vTint;
  #include <fog_pars_vertex>
  void main() {
    vTint = tint;
    vec4 mvPosition = modelViewMatrix * vec4(position, 1.0);
    gl_Position = projectionMatrix * mvPosition;
    gl_PointSize = clamp(diameter * pixelsPerRadian / -mvPosition.z, least, most);
    #include <fog_vertex>
  }`;

const FRAGMENT = /* glsl */ `
  varying vec3 vTint;
  #include <common>
  #include <fog_pars_fragment>
  void main() {
    if (length(gl_PointCoord - 0.5) > 0.5) discard;
    gl_FragColor = vec4(vTint, 1.0);
    #include <fog_fragment>
    #include <colorspace_fragment>
  }`;

// `positions` holds 3 numbers a point, `tints` as many, linear; `diameter` in metres, `least` and `most` in pixels.
export function points(positions, tints, { diameter, least, most }) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setAttribute('tint', new BufferAttribute(tints, 3, tints instanceof Uint8Array));
  const uniforms = UniformsUtils.merge([
    UniformsLib.fog,
    { diameter: { value: diameter }, least: { value: least }, most: { value: most }, pixelsPerRadian: { value: 1 } },
  ]);
  const material = new ShaderMaterial({ uniforms, vertexShader: VERTEX, fragmentShader: FRAGMENT, fog: true });
  return new Points(geometry, material);
}

// Shades of one color, `light` from 0 to 1 each. Never black, which would be taken for a shadow, nor as light as the
// background.
export function tints(color, light) {
  const { r, g, b } = new Color(color);
  const list = new Uint8Array(3 * light.length);
  light.forEach((value, i) => {
    const strength = 255 * (0.12 + 2.1 * value ** 2.2);
    list[3 * i] = Math.min(strength * r, 215);
    list[3 * i + 1] = Math.min(strength * g, 215);
    list[3 * i + 2] = Math.min(strength * b, 215);
  });
  return list;
}
