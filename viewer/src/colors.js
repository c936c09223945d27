// The colours of the picture. Probability goes from yellow to dark red and gets darker all the way, so that
// it reads without telling red from green, and in grey; the bodies keep to grey and blue.
import { Color } from 'three';

export const BACKGROUND = '#f5f7fa';
export const SCENE = '#8b949e';
export const OBJECT = '#2f7fd0';
// Of a mesh that was not asked about; clouds are grey whatever they are.
export const AROUND = '#a7c4e2';
export const ARROW = '#101418';

const STOPS = ['#ffd34e', '#fd8d3c', '#e31a1c', '#7a0022'];

export function scale(probability) {
  const at = Math.min(Math.max(probability, 0), 1) * (STOPS.length - 1);
  const stop = Math.min(Math.floor(at), STOPS.length - 2);
  return new Color(STOPS[stop]).lerp(new Color(STOPS[stop + 1]), at - stop);
}

export function paintLegend() {
  const paint = (selector, background) => {
    for (const element of document.querySelectorAll(selector)) element.style.background = background;
  };
  paint('#legend .scale', `linear-gradient(to right, ${STOPS.join(', ')})`);
  paint('#legend .dot.scene', SCENE);
  paint('#legend .dot.object', OBJECT);
  paint('#legend .dot.around', AROUND);
}
