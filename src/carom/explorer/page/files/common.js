// What all pictures share: pixels, textures, ticks and colours.  Nothing here knows a page.
export const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
export const short = (value, digits = 4) => String(Number(value.toPrecision(digits)));

// Steps for ticks: 1, 2 or 5 times a power of ten.
export const tickStep = (range, wanted) => {
  const rough = range / wanted, power = 10 ** Math.floor(Math.log10(rough));
  return power * ([1, 2, 5].find((times) => times * power >= rough) || 10);
};

// A canvas in pixels of the screen; returns its context in CSS pixels, and its side.
export const square = (canvas) => {
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
export const tile = (paper, sign) => {
  const ratio = window.devicePixelRatio || 1, name = `${paper} ${sign} ${ratio}`;
  if (tiles.has(name)) return tiles.get(name);
  const made = document.createElement("canvas");
  made.width = made.height = Math.round(8 * ratio);
  const draw = made.getContext("2d");
  draw.scale(made.width / 8, made.height / 8);
  draw.fillStyle = paper;
  draw.fillRect(0, 0, 8, 8);
  draw.strokeStyle = draw.fillStyle = inkOn(paper);
  draw.lineWidth = 1;
  if (sign === ".") draw.fillRect(3, 3, 1.6, 1.6);
  for (const [a, b, c, d] of strokes[sign] || []) {
    for (const shift of [-8, 0, 8]) { draw.beginPath(); draw.moveTo(a + shift, b); draw.lineTo(c + shift, d); draw.stroke(); }
  }
  const pixels = new Uint32Array(draw.getImageData(0, 0, made.width, made.width).data.buffer);
  tiles.set(name, { canvas: made, side: made.width, pixels });
  return tiles.get(name);
};

// Colours by name: those that the style of an element gives as custom properties, otherwise these.  They are kept until they
// are renewed: asking for one makes the browser compute all its styles.
const usual = { card: "#ffffff", ink: "#1d2329", soft: "#5b6570", rule: "#dcdcd5", wall: "#2b333b", trail: "#3d4f66", void: "#fbfaf7" };
export const inksOf = (element) => {
  let kept = {};
  const ink = (name) => (kept[name] ||= getComputedStyle(element).getPropertyValue(`--${name}`).trim() || usual[name]);
  ink.renew = () => { kept = {}; };
  return ink;
};
