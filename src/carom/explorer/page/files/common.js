"use strict";
// Parts of the page share this object; nothing else is global.
const carom = { looks: window.carom_looks, parts: [], requests: null, begun: null };
const at = (id) => document.getElementById(id);
// Colours of the page, kept until it is drawn anew: asking for one makes the browser compute all its styles.
let colours = {};
const colour = (name) => (colours[name] ||= getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
const clamp = (value, low, high) => Math.min(high, Math.max(low, value));

// A canvas in pixels of the screen; returns its context in CSS pixels, and its side.
carom.square = (canvas) => {
  const side = Math.max(40, canvas.clientWidth), ratio = window.devicePixelRatio || 1;
  if (canvas.width !== Math.round(side * ratio)) canvas.width = canvas.height = Math.round(side * ratio);
  const pen = canvas.getContext("2d");
  pen.setTransform(canvas.width / side, 0, 0, canvas.height / side, 0, 0);
  return [pen, side];
};

// Textures tell areas apart without colour; the signs are those of the hatches of carom's figures.
const strokes = { "/": [[0, 8, 8, 0]], "\\": [[0, 0, 8, 8]], x: [[0, 8, 8, 0], [0, 0, 8, 8]], ".": [] }, tiles = new Map();
const inkOn = (hex) => {
  const [red, green, blue] = [1, 3, 5].map((place) => parseInt(hex.slice(place, place + 2), 16));
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue < 90 ? "rgba(255,255,255,.45)" : "rgba(0,0,0,.28)";
};
// A square that repeats, of 8 CSS pixels in pixels of the screen: a colour, and what is hatched on it.  Made once each.
carom.tile = (paper, sign) => {
  const ratio = window.devicePixelRatio || 1, name = `${paper} ${sign} ${ratio}`;
  if (tiles.has(name)) return tiles.get(name);
  const tile = document.createElement("canvas");
  tile.width = tile.height = Math.round(8 * ratio);
  const draw = tile.getContext("2d");
  draw.scale(tile.width / 8, tile.height / 8);
  draw.fillStyle = paper;
  draw.fillRect(0, 0, 8, 8);
  draw.strokeStyle = draw.fillStyle = inkOn(paper);
  draw.lineWidth = 1;
  if (sign === ".") draw.fillRect(3, 3, 1.6, 1.6);
  for (const [a, b, c, d] of strokes[sign] || []) {
    for (const shift of [-8, 0, 8]) { draw.beginPath(); draw.moveTo(a + shift, b); draw.lineTo(c + shift, d); draw.stroke(); }
  }
  const pixels = new Uint32Array(draw.getImageData(0, 0, tile.width, tile.width).data.buffer);
  tiles.set(name, { canvas: tile, side: tile.width, pixels });
  return tiles.get(name);
};

// Steps for ticks: 1, 2 or 5 times a power of ten.
carom.step = (range, wanted) => {
  const rough = range / wanted, power = 10 ** Math.floor(Math.log10(rough));
  return power * ([1, 2, 5].find((times) => times * power >= rough) || 10);
};
carom.short = (value, digits = 4) => String(Number(value.toPrecision(digits)));

// At most one call in flight of a kind, and always the newest.
carom.throttled = (pause, call) => {
  let waiting = null, timer = 0, last = 0;
  return (...given) => {
    waiting = given;
    if (timer) return;
    timer = setTimeout(() => { timer = 0; last = performance.now(); call(...waiting); }, Math.max(0, pause - (performance.now() - last)));
  };
};

// While a slider is held, what takes the browser long is shown when nothing newer has come for a moment.
carom.unhurried = (show) => {
  let timer = 0;
  return (message) => {
    clearTimeout(timer);
    if (carom.held) timer = setTimeout(() => show(message), 300);
    else show(message);
  };
};

const dark = window.matchMedia("(prefers-color-scheme: dark)"), paper = window.matchMedia("print");
carom.redraw = () => { colours = {}; for (const part of carom.parts) part(); };
for (const query of [dark, paper]) query.addEventListener("change", () => requestAnimationFrame(carom.redraw));
window.addEventListener("beforeprint", () => carom.redraw());
window.addEventListener("resize", carom.throttled(60, () => carom.redraw()));
