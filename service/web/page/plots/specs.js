// The plots in Vega-Lite. build.mjs compiles them to Vega, so that the page needs no compiler. The page passes data, and
// params, which become signals.

const ticks = (axis) => ({
  values: {expr: `${axis}_ticks`},
  labelExpr: `${axis}_labels[indexof(${axis}_ticks, datum.value)]`,
  labelOverlap: 'greedy', labelSeparation: 6,
});
const params = (values) => Object.entries(values).map(([name, value]) => ({name, value}));
const asIs = (field) => ({field, type: 'nominal', scale: null, legend: null});

// clamp: what lies outside is drawn at the edge; otherwise where it is, for marks that are clipped.
function axis(name, type, extra = {}, clamp = true) {
  return {
    type: 'quantitative',
    scale: {type, domain: [{expr: `${name}_low`}, {expr: `${name}_high`}], nice: false, clamp, ...(type !== 'log' && {zero: false})},
    axis: {...ticks(name), title: null, ...extra},
  };
}

const range = (name, low, high) => ({[`${name}_low`]: low, [`${name}_high`]: high, [`${name}_ticks`]: [low, high], [`${name}_labels`]: ['', '']});
const ink = {expr: 'ink'}, muted = {expr: 'muted'}, paper = {expr: 'paper'};

// Cost against error. points: {key, x, low, high, y, yLow, yHigh, colour, fill, shape, size, chosen, tip, label}, dx and
// dy of the label's middle, and fromX, fromY, toX, toY of a line to it, all as offsets in pixels; lines: {technique, x, y, order, colour}; front: {x, y, order, dash}, from left to right;
// band: {x, y, y2}, where the front may be; levels: {y, dash}, explained in the text below the plot. Intervals are drawn
// `across` and `upright`. The groups of marks have the names of the layers as classes: g.lines_marks.
const xy = {x: {field: 'x', ...axis('x', 'log')}, y: {field: 'y', ...axis('y', 'log')}};
const trade = {
  width: 520, height: 340,
  params: params({...range('x', 1, 10), ...range('y', 0.01, 1), ink: '#000', muted: '#666', paper: '#fff', shade: '#ddd'}),
  layer: [
    {
      name: 'band', data: {name: 'band'},
      mark: {type: 'area', interpolate: 'step-after', fill: {expr: 'shade'}, opacity: 1, clip: true, aria: false},
      encoding: {...xy, y2: {field: 'y2'}},
    },
    {
      name: 'levels', data: {name: 'levels'},
      mark: {type: 'rule', color: muted, aria: false},
      encoding: {y: {field: 'y', ...axis('y', 'log')}, strokeDash: asIs('dash')},
    },
    {
      name: 'lines', data: {name: 'lines'},
      mark: {type: 'line', strokeWidth: 1.2, opacity: 0.75, clip: true, aria: false},
      encoding: {...xy, detail: {field: 'technique'}, order: {field: 'order'}, color: asIs('colour')},
    },
    {
      name: 'front', data: {name: 'front'},
      mark: {type: 'line', interpolate: 'step-after', color: muted, strokeWidth: 1.6, strokeJoin: 'round'},
      encoding: {...xy, order: {field: 'order'}, detail: {field: 'part'}, strokeDash: asIs('dash')},
    },
    {
      data: {name: 'points'},
      encoding: xy,
      layer: [
        {
          name: 'across', mark: {type: 'rule', strokeWidth: 1.6, clip: true, aria: false},
          encoding: {x: {field: 'low', type: 'quantitative'}, x2: {field: 'high'}, color: asIs('colour')},
        },
        {
          name: 'upright', mark: {type: 'rule', strokeWidth: 1.6, clip: true, aria: false},
          encoding: {y: {field: 'yLow', type: 'quantitative'}, y2: {field: 'yHigh'}, color: asIs('colour')},
        },
        {
          transform: [{filter: 'datum.chosen'}],
          mark: {type: 'point', shape: 'circle', size: 420, strokeWidth: 2, color: ink, filled: false, aria: false},
        },
        {
          name: 'points',
          mark: {type: 'point', opacity: 1, strokeWidth: 1.6, cursor: 'pointer'},
          encoding: {
            fill: asIs('fill'), stroke: asIs('colour'), shape: asIs('shape'), size: {field: 'size', type: 'quantitative', scale: null, legend: null},
            tooltip: {field: 'tip'}, description: {field: 'tip'},
          },
        },
        {
          name: 'leads',
          mark: {type: 'rule', strokeWidth: 1, xOffset: {expr: 'datum.fromX'}, x2Offset: {expr: 'datum.toX'}, yOffset: {expr: 'datum.fromY'}, y2Offset: {expr: 'datum.toY'}, aria: false},
          encoding: {x2: {field: 'x'}, y2: {field: 'y'}, color: asIs('colour')},
        },
        {
          name: 'halos',
          mark: {type: 'text', dx: {expr: 'datum.dx'}, dy: {expr: 'datum.dy'}, fontSize: 11, fontWeight: 600, fill: paper, stroke: paper, strokeWidth: 4, opacity: 0.85, aria: false},
          encoding: {text: {field: 'label'}},
        },
        {
          name: 'labels', mark: {type: 'text', dx: {expr: 'datum.dx'}, dy: {expr: 'datum.dy'}, fontSize: 11, fontWeight: 600, fill: ink, aria: false},
          encoding: {text: {field: 'label'}},
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
    x: {field: 'z', ...axis('x', 'linear', {}, false)}, y: {field: 'v', ...axis('y', 'linear', {minExtent: 34})},
    order: {field: 'order', type: 'quantitative'}, detail: {field: 'curve'},
    color: asIs('colour'), strokeDash: asIs('dash'), strokeWidth: {field: 'width', type: 'quantitative', scale: null, legend: null},
  },
};

// The same for their errors, in a strip below with the same depths.
const strip = {...curves, height: 110};

// A measure over runs. points: {i, value, low, high, tip}; since: {i, text}, where a drift begins.
const trend = {
  width: 300, height: 110,
  params: params({...range('x', 0, 1), ...range('y', 0, 1), line: '#00619e', muted: '#666', alarm: '#b3261e'}),
  encoding: {x: {field: 'i', ...axis('x', 'linear', {grid: false})}},
  layer: [
    {
      data: {name: 'since'},
      mark: {type: 'rule', strokeDash: [3, 3], strokeWidth: 1.5, color: {expr: 'alarm'}, aria: false},
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

export const specs = {trade, histogram, curves, strip, trend};
