// A flight on a canvas: the rotor flies inside the clearance circle, touches the wall with a flash and settles.
//
//     const shown = flight(canvas, { looks, onTime });
//     shown.show(message);   // times, x, y, impact_times, peak_loads, forward, spans, colour, hardest, time, time_unit
//     shown.play(); shown.finish(); shown.turnWith("rotating" or "fixed"); shown.rest = { position, colour };
//
// onTime(now, end) hears every instant that is drawn while it plays.
import { clamp, inksOf, short, square } from "./common.js";

export const flight = (canvas, { looks, onTime = () => {} }) => {
  const ink = inksOf(canvas), still = window.matchMedia("(prefers-reduced-motion: reduce)");
  const flashLasts = 0.45, pace = 11, shortest = 2.2, longest = 14, narrow = 200;
  const shown = { message: null, now: 0, frame: "rotating", rest: null, running: false };
  let began = 0, lasts = 1, widest = 1;

  const index = (times, now) => {
    let low = 0, high = times.length - 1;
    while (low < high) { const middle = (low + high + 1) >> 1; if (times[middle] <= now) low = middle; else high = middle - 1; }
    return low;
  };
  const turned = (message, place) => {
    const x = message.x[place], y = message.y[place];
    if (shown.frame === "rotating") return [x, y];
    const t = message.times[place], c = Math.cos(t), s = Math.sin(t);
    return [x * c - y * s, x * s + y * c];
  };

  const room = (pen, middle, reach, toX, toY, small) => {
    pen.fillStyle = ink("rule"); pen.beginPath(); pen.arc(middle, middle, reach * 1.13, 0, 7); pen.fill();
    pen.fillStyle = ink("void"); pen.beginPath(); pen.arc(middle, middle, reach, 0, 7); pen.fill();
    pen.strokeStyle = ink("wall"); pen.lineWidth = 2; pen.beginPath(); pen.arc(middle, middle, reach, 0, 7); pen.stroke();
    pen.strokeStyle = ink("rule"); pen.lineWidth = 1; pen.beginPath();
    pen.moveTo(toX(-1), middle); pen.lineTo(toX(1), middle); pen.moveTo(middle, toY(-1)); pen.lineTo(middle, toY(1)); pen.stroke();
    if (shown.frame === "rotating" && !small) {
      pen.fillStyle = ink("ink"); pen.font = "600 11px system-ui, sans-serif"; pen.textAlign = "center"; pen.textBaseline = "middle";
      pen.fillText("0°", toX(1.065), middle);
    }
  };

  // Where it has an impact: a flash that fades, and a mark that stays.
  const impacts = (pen, message, toX, toY) => {
    const { times } = message, now = shown.now, perSecond = times[times.length - 1] / lasts;
    message.impact_times.forEach((time, place) => {
      if (time > now) return;
      const [x, y] = turned(message, index(times, time)), strength = message.peak_loads[place] / (message.hardest || 1);
      pen.fillStyle = message.forward[place] ? looks.forward : looks.backward;
      pen.beginPath(); pen.arc(toX(x), toY(y), 2.2, 0, 7); pen.fill();
      const age = (now - time) / perSecond;
      if (age >= flashLasts || !shown.running) return;
      const left = 1 - age / flashLasts;
      pen.globalAlpha = left; pen.strokeStyle = looks.unstable; pen.lineWidth = 1 + 3 * strength * left;
      pen.beginPath(); pen.arc(toX(x), toY(y), 5 + (14 + 26 * strength) * (1 - left), 0, 7); pen.stroke();
      pen.fillStyle = looks.backward; pen.globalAlpha = 0.5 * left * left;
      pen.beginPath(); pen.arc(toX(x), toY(y), 4 + 10 * strength, 0, 7); pen.fill(); pen.globalAlpha = 1;
    });
  };

  shown.draw = () => {
    const message = shown.message, [pen, side] = square(canvas), small = side < narrow;
    const middle = side / 2, reach = side * 0.42 / widest, toX = (x) => middle + reach * x, toY = (y) => middle - reach * y;
    pen.clearRect(0, 0, side, side);
    room(pen, middle, reach, toX, toY, small);
    if (!message || message.refused) return;
    const { times } = message, last = index(times, shown.now);
    const stroke = (from, to, colour, width, alpha) => {
      pen.strokeStyle = colour; pen.lineWidth = width; pen.globalAlpha = alpha; pen.lineJoin = "round"; pen.beginPath();
      for (let place = from; place <= to; place += 1) { const [x, y] = turned(message, place); if (place === from) pen.moveTo(toX(x), toY(y)); else pen.lineTo(toX(x), toY(y)); }
      pen.stroke(); pen.globalAlpha = 1;
    };
    stroke(0, times.length - 1, ink("trail"), 1, 0.18);
    stroke(0, last, ink("trail"), 1, 0.55);
    const tail = index(times, Math.max(0, shown.now - 2 * Math.PI));
    for (let part = 0; part < 6; part += 1) {
      const from = tail + Math.floor((last - tail) * part / 6), to = tail + Math.floor((last - tail) * (part + 1) / 6);
      stroke(from, to, message.colour, 1.2 + 0.4 * part, 0.25 + 0.15 * part);
    }
    // Lasting contact glows on the wall.
    for (const span of message.spans) {
      if (span.start <= shown.now) stroke(index(times, span.start), index(times, Math.min(span.end, shown.now)), span.colour, 4, 0.9);
    }
    impacts(pen, message, toX, toY);
    if (shown.rest && shown.frame === "rotating") {
      pen.strokeStyle = shown.rest.colour; pen.lineWidth = 2; pen.beginPath(); pen.arc(toX(shown.rest.position[0]), toY(shown.rest.position[1]), 5, 0, 7); pen.stroke();
    }
    const [x, y] = turned(message, last);
    pen.fillStyle = message.colour; pen.strokeStyle = ink("wall"); pen.lineWidth = 1.6;
    pen.beginPath(); pen.arc(toX(x), toY(y), small ? 5 : 7, 0, 7); pen.fill(); pen.stroke();
    pen.fillStyle = ink("soft"); pen.font = `${small ? 10 : 11}px system-ui, sans-serif`; pen.textAlign = "right"; pen.textBaseline = "alphabetic";
    pen.fillText(`${short(message.time * shown.now, 3)} ${message.time_unit}`, side - 2, side - 3);
  };

  const end = () => shown.message.times[shown.message.times.length - 1];
  const advance = (clock) => {
    if (!shown.running) return;
    shown.now = Math.min(end(), end() * (clock - began) / (1000 * lasts));
    if (shown.now >= end()) shown.running = false;
    shown.draw();
    onTime(shown.now, end());
    if (shown.running) requestAnimationFrame(advance);
  };
  // Go to the last instant at once.
  shown.finish = (tell = true) => {
    if (!shown.message || shown.message.refused) return;
    shown.running = false;
    shown.now = end();
    shown.draw();
    if (tell) onTime(shown.now, shown.now);
  };
  shown.play = () => {
    if (!shown.message || shown.message.refused) return;
    lasts = clamp(end() / pace, shortest, longest);
    if (still.matches) { shown.finish(); return; }
    began = performance.now();
    if (!shown.running) { shown.running = true; requestAnimationFrame(advance); }
  };
  shown.show = (message) => {
    shown.message = message;
    // The rotor goes into a compliant wall: the picture has room to 1.13 clearances, and for more the clearance is drawn smaller.
    widest = message.refused ? 1 : message.x.reduce((most, x, place) => Math.max(most, Math.hypot(x, message.y[place]) / 1.13), 1);
    if (message.refused) { shown.running = false; shown.draw(); }
  };
  shown.clear = () => { shown.message = null; shown.running = false; shown.now = 0; shown.draw(); };
  shown.turnWith = (frame) => { shown.frame = frame; if (!shown.running) shown.draw(); };
  shown.renew = () => { ink.renew(); shown.draw(); };
  // How many times slower than the machine it is drawn; 0 where its time is not known.
  shown.slower = () => (shown.message && shown.message.time_unit === "ms" ? (1000 * lasts) / (shown.message.time * end()) : 0);
  return shown;
};
