// The clearance circle: the rotor flies, strikes with a flash and settles.
carom.motion = { message: null, now: 0, frame: "rotating" };

(() => {
  const canvas = at("clearance"), still = window.matchMedia("(prefers-reduced-motion: reduce)");
  const flashLasts = 0.45, pace = 11, shortest = 2.2, longest = 14;
  let began = 0, lasts = 1, running = false;

  const index = (times, now) => {
    let low = 0, high = times.length - 1;
    while (low < high) { const middle = (low + high + 1) >> 1; if (times[middle] <= now) low = middle; else high = middle - 1; }
    return low;
  };
  const turned = (message, place) => {
    const x = message.x[place], y = message.y[place];
    if (carom.motion.frame === "rotating") return [x, y];
    const t = message.times[place], c = Math.cos(t), s = Math.sin(t);
    return [x * c - y * s, x * s + y * c];
  };

  const draw = () => {
    const message = carom.motion.message, [pen, side] = carom.square(canvas);
    const middle = side / 2, reach = side * 0.42, toX = (x) => middle + reach * x, toY = (y) => middle - reach * y;
    pen.clearRect(0, 0, side, side);
    // The bearing, and the room inside it.
    pen.fillStyle = colour("rule"); pen.beginPath(); pen.arc(middle, middle, reach * 1.13, 0, 7); pen.fill();
    pen.fillStyle = colour("void"); pen.beginPath(); pen.arc(middle, middle, reach, 0, 7); pen.fill();
    pen.strokeStyle = colour("wall"); pen.lineWidth = 2; pen.beginPath(); pen.arc(middle, middle, reach, 0, 7); pen.stroke();
    pen.strokeStyle = colour("rule"); pen.lineWidth = 1; pen.beginPath();
    pen.moveTo(toX(-1), middle); pen.lineTo(toX(1), middle); pen.moveTo(middle, toY(-1)); pen.lineTo(middle, toY(1)); pen.stroke();
    if (carom.motion.frame === "rotating") {
      pen.fillStyle = colour("ink"); pen.font = "600 12px system-ui, sans-serif"; pen.textAlign = "center"; pen.textBaseline = "middle";
      pen.fillText("0°", toX(1.065), middle);
    }
    if (!message || message.refused) return;
    const { times } = message, now = carom.motion.now, last = index(times, now);
    const stroke = (from, to, ink, width, alpha) => {
      pen.strokeStyle = ink; pen.lineWidth = width; pen.globalAlpha = alpha; pen.lineJoin = "round"; pen.beginPath();
      for (let place = from; place <= to; place += 1) { const [x, y] = turned(message, place); if (place === from) pen.moveTo(toX(x), toY(y)); else pen.lineTo(toX(x), toY(y)); }
      pen.stroke(); pen.globalAlpha = 1;
    };
    stroke(0, times.length - 1, message.colour, 1, 0.22);
    stroke(0, last, colour("trail"), 1, 0.45);
    const tail = index(times, Math.max(0, now - 2 * Math.PI));
    for (let part = 0; part < 6; part += 1) {
      const from = tail + Math.floor((last - tail) * part / 6), to = tail + Math.floor((last - tail) * (part + 1) / 6);
      stroke(from, to, message.colour, 1 + 0.35 * part, 0.2 + 0.13 * part);
    }
    // Lasting contact glows on the wall.
    for (const span of message.spans) {
      if (span.start > now) continue;
      const from = index(times, span.start), to = index(times, Math.min(span.end, now));
      stroke(from, to, span.colour, 4, 0.9);
    }
    // Where it strikes: a flash that fades, and a mark that stays.
    const perSecond = times[times.length - 1] / lasts;
    message.impact_times.forEach((time, place) => {
      if (time > now) return;
      const [x, y] = turned(message, index(times, time)), strength = message.impulses[place] / (message.hardest || 1);
      pen.fillStyle = message.forward[place] ? carom.looks.forward : carom.looks.backward;
      pen.beginPath(); pen.arc(toX(x), toY(y), 2.2, 0, 7); pen.fill();
      const age = (now - time) / perSecond;
      if (age < flashLasts && running) {
        const left = 1 - age / flashLasts;
        pen.globalAlpha = left; pen.strokeStyle = carom.looks.unstable; pen.lineWidth = 1 + 3 * strength * left;
        pen.beginPath(); pen.arc(toX(x), toY(y), 5 + (14 + 26 * strength) * (1 - left), 0, 7); pen.stroke();
        pen.fillStyle = carom.looks.backward; pen.globalAlpha = 0.5 * left * left;
        pen.beginPath(); pen.arc(toX(x), toY(y), 4 + 10 * strength, 0, 7); pen.fill(); pen.globalAlpha = 1;
      }
    });
    const basin = carom.basin.message;
    if (basin && carom.motion.frame === "rotating") {
      const [x, y] = basin.rest_position;
      pen.strokeStyle = basin.legend_rest; pen.lineWidth = 2; pen.beginPath(); pen.arc(toX(x), toY(y), 5, 0, 7); pen.stroke();
    }
    const [x, y] = turned(message, last);
    pen.fillStyle = message.colour; pen.strokeStyle = colour("card"); pen.lineWidth = 2;
    pen.beginPath(); pen.arc(toX(x), toY(y), 7.5, 0, 7); pen.fill(); pen.stroke();
    pen.fillStyle = colour("soft"); pen.font = "12px system-ui, sans-serif"; pen.textAlign = "right"; pen.textBaseline = "alphabetic";
    pen.fillText(`${carom.short(message.time * now, 3)} ${message.time_unit}`, side - 4, side - 5);
    pen.textAlign = "left";
    pen.fillText(carom.motion.frame === "rotating" ? "turns with the shaft" : "as seen from outside", 4, side - 5);
  };

  const advance = (clock) => {
    if (carom.held) running = false; // that of an older machine
    if (!running) return;
    const message = carom.motion.message, end = message.times[message.times.length - 1];
    carom.motion.now = Math.min(end, end * (clock - began) / (1000 * lasts));
    draw();
    if (carom.plots) carom.plots.now(carom.motion.now, carom.motion.now >= end);
    if (carom.motion.now >= end) running = false; else requestAnimationFrame(advance);
  };
  carom.motion.play = () => {
    const message = carom.motion.message;
    if (!message || message.refused) return;
    const end = message.times[message.times.length - 1];
    lasts = clamp(end / pace, shortest, longest);
    const slower = message.time_unit === "ms" ? (1000 * lasts) / (message.time * end) : 0;
    at("pace").textContent = slower > 1.5 ? `slowed down ${carom.short(slower, 2)} times` : "";
    if (still.matches || carom.held) { carom.motion.now = end; running = false; draw(); if (carom.plots && !carom.held) carom.plots.now(end, true); return; }
    began = performance.now();
    if (!running) { running = true; requestAnimationFrame(advance); }
  };
  carom.motion.show = (message) => {
    carom.motion.message = message;
    carom.panels.shown("motion", message);
    if (message.refused) { at("motion-words").textContent = message.refused; running = false; draw(); return; }
    at("motion-words").textContent = message.words + (message.whole ? "" : " Its beginning is shown.");
    if (carom.plots) carom.plots.motion(message);
    carom.motion.play();
  };
  at("replay").addEventListener("click", () => carom.motion.play());
  for (const choice of document.querySelectorAll('input[name="frame"]')) {
    choice.addEventListener("change", () => { carom.motion.frame = choice.value; if (!running) draw(); });
  }
  carom.parts.push(draw);
})();
