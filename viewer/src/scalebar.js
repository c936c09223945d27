// A bar of a round length, true at the place the picture turns about, and the axes of the scene.
import { Vector3 } from 'three';

const AXES = [['x', '#b3261e'], ['y', '#4d7c0f'], ['z', '#1d4ed8']];
const SVG = 'http://www.w3.org/2000/svg';

export function overlay(container) {
  const bar = container.appendChild(document.createElement('div'));
  bar.className = 'bar';
  const svg = container.appendChild(document.createElementNS(SVG, 'svg'));
  svg.setAttribute('class', 'axes');
  svg.setAttribute('viewBox', '-40 -40 80 80');
  svg.setAttribute('role', 'img');
  svg.setAttribute('aria-label', 'axes of the scene');
  const arms = AXES.map(([name, color]) => {
    const line = svg.appendChild(document.createElementNS(SVG, 'line'));
    line.setAttribute('stroke', color);
    const text = svg.appendChild(document.createElementNS(SVG, 'text'));
    text.setAttribute('fill', color);
    text.textContent = name;
    return [line, text];
  });
  return (camera, target, height) => {
    const metres = (2 * camera.position.distanceTo(target) * Math.tan((camera.fov * Math.PI) / 360)) / height;
    const length = roundLength(120 * metres);
    bar.style.width = `${length / metres}px`;
    bar.textContent = spelled(length);
    arms.forEach(([line, text], k) => {
      const arm = new Vector3().setComponent(k, 1).applyQuaternion(camera.quaternion.clone().invert());
      line.setAttribute('x2', 26 * arm.x);
      line.setAttribute('y2', -26 * arm.y);
      text.setAttribute('x', 34 * arm.x);
      text.setAttribute('y', -34 * arm.y);
    });
  };
}

// The largest of 1, 2 and 5 times a power of ten that is not longer.
function roundLength(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].map((n) => n * power).find((length) => length <= most) ?? power;
}

function spelled(metres) {
  const in_unit = (value, unit) => `${Number(value.toPrecision(2))} ${unit}`;
  if (metres < 0.01) return in_unit(1000 * metres, 'mm');
  return metres < 1 ? in_unit(100 * metres, 'cm') : in_unit(metres, 'm');
}
