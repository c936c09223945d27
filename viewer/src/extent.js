// How large what is drawn is, for a camera that is to show it.
import { Box3 } from 'three';

// The box around the bodies of known shape.
export function known(around) {
  const boxes = around.filter(({ isCloud }) => !isCloud).map(({ box }) => box);
  return boxes.reduce((all, box) => all.union(box), new Box3());
}

// How large to take what is shown for: what is a single point, for a part of what is around it.
export function sizeOf(radius, around) {
  return radius > 0 ? radius : 0.05 * around || 1;
}
