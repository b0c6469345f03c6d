// What a recommendation is asked for: the error that is allowed and the time it may take. Both stand in the card of the
// first page and beside the text of a scenario, and in the address: #/?error=0.02&within=5.
import {address} from './address.js';
import {choice, h} from './dom.js';

const least = 0.0001, most = 1, usual = {error: 0.05, minutes: 2};
const times = [1, 2, 5, 15, 25];  // minutes
const places = [0, 1];

const inRange = (error) => error >= least && error <= most;

export function question({signal}) {
  const errors = places.map(() => h('input', {type: 'number', min: least, max: most, step: 'any', required: true, 'aria-label': 'Error that is allowed',
    oninput: ({target}) => {
      for (const field of errors) if (field !== target) field.value = target.value;
      address.keep({error: target.value !== '' && inRange(Number(target.value)) ? Number(target.value) : null});
    }}));
  const minutes = places.map(() => choice('within', times.map((n) => ({value: n, text: `${n} min`})), usual.minutes, (n) => {
    address.go({within: Number(n) === usual.minutes ? null : n});
    for (const list of lists) list.value = n;
  }));
  const lists = minutes.map((element) => element.querySelector('select'));
  function read() {
    const [error] = address.numbers('error', 1) ?? [], time = Number(address.get('within'));
    for (const field of errors) field.value = String(inRange(error) ? error : usual.error);
    for (const list of lists) list.value = String(times.includes(time) ? time : usual.minutes);
  }
  read();
  addEventListener('hashchange', read, {signal});
  return {
    errors, minutes,  // of the card, and beside the text
    error: () => Number(errors[0].value),
    seconds: () => 60 * Number(lists[0].value),
    asked: () => address.get('error') !== null,  // somebody said which error is allowed
    valid: () => errors[1].reportValidity(),
  };
}
