// The way from pose to pose: a list of scenes and objects where there are several, and a slider.
import { scale } from './colors.js';

export class Poses {
  // `show` is called with the number of a view.
  constructor(container, { views, bodies, is_one_scene: isOneScene }, show) {
    this.show = show;
    this.views = views;
    this.pairs = pairs(views, isOneScene);
    if (views.length < 2) return;
    this.choice = container.appendChild(document.createElement('select'));
    this.choice.setAttribute('aria-label', 'scene and object');
    for (const [first] of this.pairs) {
      const { asked } = views[first];
      const option = this.choice.appendChild(document.createElement('option'));
      option.textContent = asked ? `${bodies[asked.object.body].name} in ${bodies[asked.scene.body].name}` : views[first].name;
    }
    this.choice.hidden = this.pairs.length < 2;
    this.choice.addEventListener('change', () => this.go(this.pairs[this.choice.selectedIndex][0]));
    this.strip = container.appendChild(document.createElement('div'));
    this.strip.className = 'strip';
    this.slider = container.appendChild(document.createElement('input'));
    this.slider.type = 'range';
    this.slider.min = 0;
    this.word = isOneScene ? 'view' : 'pose';
    this.slider.setAttribute('aria-label', this.word);
    this.slider.addEventListener('input', () => this.go(this.pairs[this.pair][this.slider.value]));
    this.caption = container.appendChild(document.createElement('p'));
    this.caption.className = 'small';
  }

  go(number) {
    const pair = this.pairs.findIndex((list) => list.includes(number));
    const list = this.pairs[pair];
    const at = list.indexOf(number);
    if (this.slider) {
      if (pair !== this.pair) this.drawStrip(list);
      this.choice.selectedIndex = pair;
      this.slider.max = list.length - 1;
      this.slider.value = at;
      const words = `${this.word} ${at + 1} of ${list.length}`;
      this.slider.setAttribute('aria-valuetext', `${words}: ${this.views[number].name}`);
      this.caption.textContent = `${words}; bars: probability of a collision, with its upper bound`;
      this.slider.disabled = list.length < 2;
      [...this.strip.children].forEach((bar, i) => bar.classList.toggle('now', i === at));
    }
    this.pair = pair;
    this.show(number);
  }

  // A bar for every pose, as high as its probability; a thin line where its upper bound is.
  drawStrip(list) {
    this.strip.replaceChildren(...list.map((number) => {
      const { asked, name } = this.views[number];
      const column = document.createElement('div');
      column.title = name;
      column.addEventListener('click', () => this.go(number));
      if (!asked) return column;
      const { probability, bounds } = asked;
      const bar = column.appendChild(document.createElement('i'));
      bar.style.height = `${100 * probability}%`;
      bar.style.background = `#${scale(probability).getHexString()}`;
      const bound = column.appendChild(document.createElement('u'));
      bound.style.bottom = `${100 * bounds[1]}%`;
      return column;
    }));
  }
}

// Numbers of the views of each scene and object, in order; of one scene all together.
function pairs(views, isOneScene) {
  const lists = new Map();
  views.forEach(({ asked }, number) => {
    const key = isOneScene || !asked ? '' : `${asked.scene.body} ${asked.object.body}`;
    if (!lists.has(key)) lists.set(key, []);
    lists.get(key).push(number);
  });
  return [...lists.values()];
}
