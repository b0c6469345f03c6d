// The plots in Vega-Lite. build.mjs compiles them to Vega, so that the page needs no compiler. The page passes data, and
// params, which become signals.

const ticks = (axis) => ({
  values: {expr: `${axis}_ticks`},
  labelExpr: `${axis}_labels[indexof(${axis}_ticks, datum.value)]`,
  labelOverlap: 'greedy', labelSeparation: 6,
});
const params = (values) => Object.entries(values).map(([name, value]) => ({name, value}));
const asIs = (field) => ({field, type: 'nominal', scale: null, legend: null});

function axis(name, type, extra = {}) {
  return {
    type: 'quantitative',
    scale: {type, domain: [{expr: `${name}_low`}, {expr: `${name}_high`}], nice: false, clamp: true, ...(type !== 'log' && {zero: false})},
    axis: {...ticks(name), title: null, ...extra},
  };
}

const range = (name, low, high) => ({[`${name}_low`]: low, [`${name}_high`]: high, [`${name}_ticks`]: [low, high], [`${name}_labels`]: ['', '']});
const ink = {expr: 'ink'}, muted = {expr: 'muted'}, paper = {expr: 'paper'};

// Cost against error. points: {n, key, x, low, high, y, colour, shape, chosen, tip}, and dx and dy of the number's middle;
// front: {x, y}, from left to right; levels: {y, dash}, explained in the text below the plot.
const trade = {
  width: 520, height: 320,
  params: params({...range('x', 1, 10), ...range('y', 0.01, 1), ink: '#000', muted: '#666', paper: '#fff'}),
  layer: [
    {
      data: {name: 'levels'},
      mark: {type: 'rule', color: muted},
      encoding: {y: {field: 'y', ...axis('y', 'log')}, strokeDash: asIs('dash')},
    },
    {
      data: {name: 'front'},
      mark: {type: 'line', interpolate: 'step-after', color: muted, strokeWidth: 1.4, strokeJoin: 'round'},
      encoding: {x: {field: 'x', ...axis('x', 'log')}, y: {field: 'y', ...axis('y', 'log')}, order: {field: 'order'}},
    },
    {
      data: {name: 'points'},
      encoding: {x: {field: 'x', ...axis('x', 'log')}, y: {field: 'y', ...axis('y', 'log')}},
      layer: [
        {
          mark: {type: 'rule', strokeWidth: 1.6, aria: false},
          encoding: {x: {field: 'low', type: 'quantitative'}, x2: {field: 'high'}, color: asIs('colour')},
        },
        {
          transform: [{filter: 'datum.chosen'}],
          mark: {type: 'point', shape: 'circle', size: 420, strokeWidth: 2, color: ink, filled: false, aria: false},
        },
        {
          name: 'points',
          mark: {type: 'point', filled: true, size: 120, opacity: 1, strokeWidth: 1.2, stroke: paper, cursor: 'pointer'},
          encoding: {fill: asIs('colour'), shape: asIs('shape'), tooltip: {field: 'tip'}, description: {field: 'tip'}},
        },
        {
          mark: {type: 'text', dx: {expr: 'datum.dx'}, dy: {expr: 'datum.dy'}, fontSize: 11, fontWeight: 600, fill: ink, aria: false},
          encoding: {text: {field: 'n'}},
        },
      ],
    },
  ],
};

// bars: {from, to, count, tip}; counts on a symmetric log axis, so that one pixel among thousands is visible.
const histogram = {
  width: 420, height: 150,
  params: params({...range('x', 0, 1), ...range('y', 0, 1), bar: '#00619e'}),
  data: {name: 'bars'},
  mark: {type: 'bar', fill: {expr: 'bar'}, x2Offset: -1},
  encoding: {
    x: {field: 'from', ...axis('x', 'linear', {grid: false})}, x2: {field: 'to'},
    y: {field: 'count', ...axis('y', 'symlog')}, y2: {datum: 0},
    tooltip: {field: 'tip'}, description: {field: 'tip'},
  },
};

// Visibility against depth. vertices: {curve, order, z, v, colour, dash, width}, in the order of each function's
// vertices: two at one depth are a step, which sorting by depth would break.
const curves = {
  width: 560, height: 300,
  params: params({...range('x', 0, 1), ...range('y', 0, 1)}),
  data: {name: 'vertices'},
  mark: {type: 'line', interpolate: 'linear', clip: true, strokeJoin: 'round', strokeCap: 'butt'},
  encoding: {
    x: {field: 'z', ...axis('x', 'linear')}, y: {field: 'v', ...axis('y', 'linear')},
    order: {field: 'order', type: 'quantitative'}, detail: {field: 'curve'},
    color: asIs('colour'), strokeDash: asIs('dash'), strokeWidth: {field: 'width', type: 'quantitative', scale: null, legend: null},
  },
};

// A measure over runs. points: {i, value, low, high, tip}; since: {i, text}, where a drift begins.
const trend = {
  width: 300, height: 110,
  params: params({...range('x', 0, 1), ...range('y', 0, 1), line: '#00619e', muted: '#666', alarm: '#b3261e'}),
  encoding: {x: {field: 'i', ...axis('x', 'linear', {grid: false})}},
  layer: [
    {
      data: {name: 'since'},
      mark: {type: 'rule', strokeDash: [3, 3], strokeWidth: 1.5, color: {expr: 'alarm'}},
    },
    {
      data: {name: 'points'},
      mark: {type: 'rule', color: {expr: 'line'}, opacity: 0.45, strokeWidth: 3, aria: false},
      encoding: {y: {field: 'low', ...axis('y', 'linear')}, y2: {field: 'high'}},
    },
    {
      data: {name: 'points'},
      mark: {type: 'line', color: {expr: 'line'}, strokeWidth: 1.4},
      encoding: {y: {field: 'value', ...axis('y', 'linear')}},
    },
    {
      data: {name: 'points'},
      mark: {type: 'point', filled: true, size: 34, opacity: 1, color: {expr: 'line'}},
      encoding: {y: {field: 'value', ...axis('y', 'linear')}, tooltip: {field: 'tip'}, description: {field: 'tip'}},
    },
  ],
};

export const specs = {trade, histogram, curves, trend};
