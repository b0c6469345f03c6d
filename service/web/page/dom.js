// Makes elements without parsing markup: data always becomes text.

const svgSpace = 'http://www.w3.org/2000/svg';

function build(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

// h('a', {href: '#/'}, 'text', otherElement): skips children that are null, undefined or false.
export function h(tag, attributes, ...children) {
  return build(document.createElement(tag), attributes, children);
}

export function svg(tag, attributes, ...children) {
  return build(document.createElementNS(svgSpace, tag), attributes, children);
}

// Sets a text only if it changes, so that it does not disturb screen readers and selections.
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

// A labelled choice. options: [{value, text}]; change(value) is called for each choice.
export function choice(label, options, value, change) {
  const select = h('select', {onchange: () => change(select.value)},
    options.map((o) => h('option', {value: o.value, selected: String(o.value) === String(value)}, o.text)));
  return h('label', {class: 'choice'}, h('span', {}, label), select);
}

// Announces a text to screen readers, after what they are reading.
export function announce(text) {
  const status = document.getElementById('status');
  if (status) setText(status, text);
}

export function download(name, type, text) {
  const url = URL.createObjectURL(new Blob([text], {type}));
  h('a', {href: url, download: name}).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

// A command with a button that copies it.
export function command(text) {
  const button = h('button', {type: 'button', class: 'quiet', onclick: async () => {
    try {
      await navigator.clipboard.writeText(text);
      setText(button, 'Copied');
    } catch {
      getSelection().selectAllChildren(code);
      setText(button, 'Selected');
    }
    setTimeout(() => setText(button, 'Copy'), 1500);
  }}, 'Copy');
  const code = h('code', {}, text);
  return h('div', {class: 'command'}, code, button);
}
