// The script of a report page: draws what the page carries, and shows the words of one pose at a time.
import { paintLegend } from './colors.js';
import { Picture } from './picture.js';
import { Poses } from './poses.js';

const data = JSON.parse(document.getElementById('data').textContent);
const container = document.getElementById('picture');

function start() {
  paintLegend();
  let picture;
  try {
    picture = new Picture(container, data);
  } catch (error) {
    // The words stay: only the picture needs WebGL.
    console.warn(error);
    container.append('This browser shows no picture: WebGL is not available.');
  }
  const buttons = picture && drawButtons(picture);
  const show = (number) => {
    for (const section of document.querySelectorAll('section.answer')) {
      section.hidden = section.id !== `answer-${number}`;
    }
    const view = data.views[number];
    if (!picture) return;
    picture.show(view);
    buttons.contact.disabled = !view.asked?.contacts.length;
    buttons.tellTurn();
  };
  const poses = new Poses(document.getElementById('poses'), data, show);
  // `report.html#3` opens at the third pose, and goes there in a page that is open.
  const named = () => Number(window.location.hash.slice(1)) - 1;
  poses.go(data.views[named()] ? named() : data.start);
  window.addEventListener('hashchange', () => {
    if (data.views[named()]) poses.go(named());
  });
  picture?.resize();
  picture?.frame('object', true);
}

function drawButtons(picture) {
  const row = container.appendChild(document.createElement('div'));
  row.className = 'buttons';
  const button = (words, act) => {
    const element = row.appendChild(document.createElement('button'));
    element.type = 'button';
    element.textContent = words;
    element.addEventListener('click', act);
    return element;
  };
  const cut = button('Cut away what is in front', () => {
    picture.isCut = !picture.isCut;
    cut.setAttribute('aria-pressed', picture.isCut);
    picture.wish();
  });
  cut.setAttribute('aria-pressed', picture.isCut);
  const other = () => (picture.upright === 'z' ? 'camera' : 'z');
  const turned = () => (picture.upright === 'z' ? 'z is up' : 'as the camera saw it');
  button('Object', () => picture.frame('object'));
  const contact = button('Contact', () => picture.frame('contact'));
  button('Whole scene', () => picture.frame('scene'));
  const turn = button(turned(), () => {
    picture.turnScene(other());
    tellTurn();
  });
  const tellTurn = () => {
    turn.textContent = turned();
  };
  turn.title = 'which way is up';
  return { contact, tellTurn };
}

if (data.views.length > 0) {
  start();
} else {
  document.getElementById('legend').remove();
  container.append('No pose has an answer: there is nothing to draw.');
}
