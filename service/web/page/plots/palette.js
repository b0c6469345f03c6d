// Colours and shapes of techniques: after Okabe and Ito, Color Universal Design (2008), adjusted to a contrast of at least
// 3 to 1 with the background. Each technique has its own colour and its own shape, so that either identifies it.
import {svg} from '../dom.js';

const colours = {
  light: ['#00619e', '#c24a00', '#00795a', '#a0427a', '#7d6400', '#5a4fc4', '#2f83b7', '#5c5c5c'],
  dark: ['#58b4ee', '#ff9052', '#30c99c', '#ea93c6', '#e3c14b', '#aea5ff', '#9fdcff', '#c8c8c8'],
};

// Paths within the square from -1 to 1.
const shapes = [
  'M0,-0.9A0.9,0.9,0,1,1,0,0.9A0.9,0.9,0,1,1,0,-0.9Z',
  'M-0.8,-0.8H0.8V0.8H-0.8Z',
  'M0,-1L1,0.75H-1Z',
  'M0,-1L1,0L0,1L-1,0Z',
  'M0,1L1,-0.75H-1Z',
  'M-0.33,-1H0.33V-0.33H1V0.33H0.33V1H-0.33V0.33H-1V-0.33H-0.33Z',
  'M0,-1L0.29,-0.4L0.95,-0.31L0.48,0.15L0.59,0.81L0,0.5L-0.59,0.81L-0.48,0.15L-0.95,-0.31L-0.29,-0.4Z',
];
const dashes = [[1, 0], [7, 3], [2, 2], [8, 3, 2, 3], [12, 4], [4, 4], [1, 3], [10, 2, 2, 2, 2, 2]];

const darkness = matchMedia('(prefers-color-scheme: dark)');

export function onThemeChange(changed, signal) {
  darkness.addEventListener('change', changed, {signal});
}

export function lookOf(index) {
  const palette = colours[darkness.matches ? 'dark' : 'light'];
  return {colour: palette[index % palette.length], shape: shapes[index % shapes.length]};
}

// A stretch of the line of a function, in the colour of its technique and with its own dash.
export function lineSample(index, number) {
  return svg('svg', {viewBox: '0 0 30 8', class: `line-sample series-${index % colours.light.length}`, 'aria-hidden': 'true'},
    svg('path', {d: 'M0,4H30', 'stroke-dasharray': dashOf(number).join(' ')}));
}

// A stretch of a line across a plot.
export function levelSample(dash) {
  return svg('svg', {viewBox: '0 0 30 8', class: 'line-sample', 'aria-hidden': 'true'}, svg('path', {d: 'M0,4H30', 'stroke-dasharray': dash.join(' ')}));
}

export function dashOf(number) {
  return dashes[number % dashes.length];
}

// The mark of a technique, for tables and lists; its colour is the class series-<n> of the style sheet.
export function glyph(index) {
  return svg('svg', {viewBox: '-1.2 -1.2 2.4 2.4', class: `glyph series-${index % colours.light.length}`, 'aria-hidden': 'true'},
    svg('path', {d: lookOf(index).shape}));
}
