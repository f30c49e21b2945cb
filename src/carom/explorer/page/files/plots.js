// The figures with axes, drawn by Bokeh: the browser fills them and gives them the colours of the page.
carom.begin_plots = (parts, plots) => {
  const motion = { message: null, drawn: -1, count: -1 };
  let along = null, special = null;
  // Near-black is not seen on dark paper.
  const mark = () => {
    if (!special) return;
    const inked = special.colour.map((one) => (one === carom.looks.wall ? colour("ink") : one));
    parts.points.data = { ...special, colour: inked, fill: special.admissible.map((one) => (one ? 1 : 0)) };
  };
  const theme = () => {
    const ink = carom.themed(plots);
    parts.cursor.line_color = colour("ink");
    parts.now.line_color = ink;
    const path = plots.history.renderers.find((one) => one.name === "path"), wall = plots.history.center.find((one) => one.name === "wall");
    if (path) path.glyph.line_color = colour("trail");
    if (wall) wall.line_color = colour("wall");
    mark();
  };
  plots.history.left[0].axis_label = "radius (of the clearance)";
  plots.section.below[0].axis_label = "angle on the bearing (°)";
  theme();
  carom.parts.push(theme);

  // The same marks as in carom's figures: by the direction of whirl, told apart without colour.
  const marks = (forward) => ({
    colour: forward.map((one) => (one ? carom.looks.forward : carom.looks.backward)),
    marker: forward.map((one) => (one ? "triangle" : "inverted_triangle")),
  });

  const section = (now) => {
    const message = motion.message, count = message.impact_times.filter((time) => time <= now).length;
    if (count === motion.count) return;
    motion.count = count;
    const first = (values) => Array.from(values).slice(0, count), forward = first(message.forward);
    parts.section.data = {
      angle: first(message.impact_angles).map((angle) => 180 * angle / Math.PI),
      speed: first(message.impact_speeds).map((speed) => message.speed * speed),
      ...marks(forward),
    };
  };

  carom.plots = {
    motion: carom.unhurried((message) => {
      motion.message = message;
      motion.count = -1;
      const { times, x, y } = message, end = message.time * times[times.length - 1];
      const r = Array.from(x, (part, place) => Math.hypot(part, y[place]));
      // A rigid wall stands at one; into one that gives way the rotor goes farther.
      const top = r.reduce((most, radius) => Math.max(most, radius + 0.04), 1.06);
      parts.history.data = { t: Array.from(times, (time) => message.time * time), r };
      parts.struck.data = {
        t: Array.from(message.impact_times, (time) => message.time * time), r: Array.from(message.impact_times, () => top - 0.03),
        ...marks(Array.from(message.forward)),
      };
      parts.history_x.setv({ start: 0, end });
      parts.history_y.setv({ start: 0, end: top });
      plots.history.below[0].axis_label = `time (${message.time_unit})`;
      plots.section.left[0].axis_label = `radial speed (${message.speed_unit})`;
      parts.section_y.setv({ start: 0, end: 1.1 * message.speed * Math.max(...message.impact_speeds, 1e-3) });
      const all = (value) => message.spans.map(() => value);
      parts.spans.data = {
        left: message.spans.map((span) => message.time * span.start), right: message.spans.map((span) => message.time * span.end),
        bottom: all(0), top: all(top), colour: message.spans.map((span) => span.colour),
      };
      const kinds = new Map(message.spans.map((span) => [span.words, span.colour]));
      at("regimes").replaceChildren(...[...kinds].flatMap(([words, ink]) => {
        const key = document.createElement("i");
        key.className = "key"; key.style.background = ink;
        return [key, words];
      }));
      carom.panels.shown("figures", message);
      carom.plots.now(carom.motion.now, true);
    }),
    now: (time, last) => {
      const clock = performance.now();
      if (!motion.message || (!last && clock - motion.drawn < 120)) return;
      motion.drawn = clock;
      parts.now.location = motion.message.time * time;
      section(time);
    },
    diagram: (message) => {
      if (message.refused) { at("diagram-words").textContent = message.refused; return; }
      along = message.name;
      at("along").textContent = message.words;
      plots.diagram.below[0].axis_label = `${message.words}${message.unit ? ` (${message.unit})` : ""}`;
      plots.diagram.left[0].axis_label = `impact speed (${message.speed_unit})`;
      parts.diagram_x.setv({ start: message.low, end: message.high });
      parts.diagram_y.setv({ start: -0.16 * message.top, end: message.top });
      for (const kind of ["virtual", "unstable", "stable"]) {
        const lines = message.lines.filter((line) => line.kind === kind);
        parts[`lines_${kind}`].data = { xs: lines.map((line) => line.x), ys: lines.map((line) => line.y) };
      }
      const row = (bar) => (bar.words === "levitation" ? 0 : 1);
      parts.bars.data = {
        left: message.bars.map((bar) => bar.low), right: message.bars.map((bar) => bar.high), colour: message.bars.map((bar) => bar.colour), words: message.bars.map((bar) => bar.words),
        top: message.bars.map((bar) => -(0.04 + 0.06 * row(bar)) * message.top), bottom: message.bars.map((bar) => -(0.08 + 0.06 * row(bar)) * message.top),
      };
      special = message.points;
      mark();
      carom.showCursor(along, carom.controls.value(along));
    },
  };
  carom.on("diagram", carom.plots.diagram);
  carom.showCursor = (name, value) => { if (name === along) parts.cursor.location = value; };
  if (carom.motion.message && !carom.motion.message.refused) carom.plots.motion(carom.motion.message);
};
