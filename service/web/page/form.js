// A form for the common choices of a scenario. It shows what the text says and writes the text again for each change.
import {get} from './api.js';
import {h, setText} from './dom.js';
import {written} from './format.js';
import {keepsDigits, lightPlace, typesOf, withLight, withRays, withTypes} from './choices.js';

const resolutions = [64, 128, 256, 512, 1024, 2048], samples = [1, 4, 9, 16, 36, 64];

function numberField(name, unit, attributes, change) {
  const input = h('input', {type: 'number', step: '1', ...attributes, onchange: () => { if (input.value !== '' && input.checkValidity()) change(Number(input.value)); }});
  return {input, element: h('label', {class: 'choice'}, h('span', {}, name), input, unit && h('span', {}, unit))};
}

function listField(name, values, change) {
  const select = h('select', {onchange: () => change(Number(select.value))});
  return {
    element: h('label', {class: 'choice'}, h('span', {}, name), select),
    show(value) {
      const known = Number.isInteger(value) && !values.includes(value) ? [...values, value].sort((a, b) => a - b) : values;
      select.replaceChildren(...(Number.isInteger(value) ? [] : [h('option', {value: ''}, '–')]), ...known.map((v) => h('option', {value: v, selected: v === value}, String(v))));
      select.disabled = !Number.isInteger(value);
    },
  };
}

// text() and write(text): of the editor. `error`: the field of the error that is asked for. show() is to be called after each change
// of the text.
export function choicesForm({text, write, error, signal}) {
  const parsed = () => {
    try { return JSON.parse(text()); } catch { return null; }
  };
  const change = (make) => {
    const scenario = parsed();
    if (scenario && keepsDigits(text())) write(written(make(scenario)));
  };
  let all = [];
  const light = (part) => (value) => change((s) => (lightPlace(s) ? withLight(s, {...lightPlace(s), [part]: value}) : s));
  const around = numberField('light from', '°', {min: '0', max: '360'}, light('around'));
  const height = numberField('its height', '°', {min: '-90', max: '90'}, light('height'));
  const resolution = listField('pixels a side', resolutions, (v) => change((s) => withRays(s, 'resolution', v)));
  const rays = listField('rays a pixel', samples, (v) => change((s) => withRays(s, 'samples_per_pixel', v)));
  const boxes = h('div', {class: 'boxes'}), said = h('p', {class: 'note'});
  const fields = h('fieldset', {class: 'common'}, h('legend', {}, 'Common choices'),
    h('div', {class: 'choices'}, around.element, height.element), h('div', {class: 'choices'}, resolution.element, rays.element),
    h('div', {role: 'group', 'aria-label': 'Techniques'}, h('p', {class: 'axis-title'}, 'techniques'), boxes),
    h('label', {class: 'choice'}, h('span', {}, 'error asked for'), error), said);

  function show() {
    const scenario = parsed(), rays_ = scenario?.rays ?? {}, can = scenario !== null && keepsDigits(text());
    fields.disabled = !can;
    setText(said, can || !text() ? '' : scenario ? 'This text has numbers with more digits than a form keeps. Change it as text.' : 'The text is not JSON yet.');
    const place = lightPlace(scenario);
    for (const [field, part] of [[around, 'around'], [height, 'height']]) {
      field.input.disabled = !place;
      field.input.value = place ? String(place[part]) : '';
    }
    resolution.show(rays_.resolution);
    rays.show(rays_.samples_per_pixel);
    const types = typesOf(scenario, all);
    for (const box of boxes.querySelectorAll('input')) {
      box.checked = types.has(box.value);
      box.disabled = !Array.isArray(scenario?.techniques);
    }
  }
  get('/v1/techniques', signal).then(({techniques}) => {
    all = techniques.map((t) => t.id);
    boxes.replaceChildren(...techniques.map((t) => h('label', {class: 'check', title: t.title},
      h('input', {type: 'checkbox', value: t.id, onchange: () => {
        const types = new Set([...boxes.querySelectorAll('input:checked')].map((box) => box.value));
        change((s) => withTypes(s, types, all));
      }}), t.id)));
    show();
  }).catch((error) => { if (!signal.aborted) setText(said, error.message); });
  return {element: fields, show};
}
