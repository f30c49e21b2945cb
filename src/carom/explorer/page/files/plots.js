// The figures with axes, drawn by Bokeh: the browser fills them and gives them the colours of the page.
carom.begin_plots = (parts, plots) => {
  const motion = { message: null, drawn: -1, count: -1 };
  const inks = [carom.looks.stable, carom.looks.unstable, carom.looks["contact-free"], carom.looks.rub];
  const inkOf = (place) => inks[place % inks.length];
  let along = null, special = null;
  const keys = (place, names) => place.replaceChildren(...names.map(([words, ink, dashed]) => {
    const entry = document.createElement("span"), key = document.createElement("i");
    key.className = `line${dashed ? " dashed" : ""}`;
    key.style.borderColor = ink;
    entry.append(key, words);
    return entry;
  }));
  for (const key of document.querySelectorAll("[data-colour]")) key.style.borderColor = inkOf(+key.dataset.colour);
  // Near-black is not seen on dark paper.
  const mark = () => {
    if (!special) return;
    const inked = special.colour.map((one) => (one === carom.looks.wall ? colour("ink") : one));
    parts.points.data = { ...special, colour: inked, fill: special.admissible.map((one) => (one ? 1 : 0)) };
  };
  const theme = () => {
    const ink = carom.themed(plots);
    for (const name of ["cursor", "speed"]) if (parts[name]) parts[name].line_color = colour("ink");
    for (const name of ["now", "now_too"]) if (parts[name]) parts[name].line_color = ink;
    for (const plot of Object.values(plots)) {
      for (const one of plot.renderers) if (one.name === "wall") one.glyph.line_color = colour("wall");
      for (const one of plot.center) if (one.name === "wall") one.line_color = colour("wall");
    }
    mark();
  };
  plots.distances.left[0].axis_label = "distance (of the clearance)";
  plots.section.below[0].axis_label = "angle on the bearing (°)";
  if (plots.response) {
    plots.response.below[0].axis_label = "speed (rpm)";
    plots.response.left[0].axis_label = "amplitude, 0-to-peak (µm)";
  }
  theme();
  carom.parts.push(theme);

  // The same marks as in carom's figures: by the direction of whirl, distinguished without colour.
  const marks = (forward) => ({
    colour: forward.map((one) => (one ? carom.looks.forward : carom.looks.backward)),
    marker: forward.map((one) => (one ? "triangle" : "inverted_triangle")),
  });

  // Columns of the planes one after another.
  const joined = (planes, column) => planes.flatMap((one) => Array.from(one[column]));
  const section = (now) => {
    const { planes, speed } = motion.message, times = joined(planes, "impact_times");
    const chosen = times.map((_, place) => place).filter((place) => times[place] <= now);
    if (chosen.length === motion.count) return;
    motion.count = chosen.length;
    const of = (column) => { const all = joined(planes, column); return chosen.map((place) => all[place]); };
    parts.section.data = {
      angle: of("impact_angles").map((angle) => 180 * angle / Math.PI), speed: of("impact_speeds").map((one) => speed * one), ...marks(of("forward")),
    };
  };

  carom.plots = {
    motion: carom.unhurried((message) => {
      motion.message = message;
      motion.count = -1;
      const { planes, time } = message, t = Array.from(message.times, (one) => time * one), end = t[t.length - 1], ink = planes.map((_, place) => inkOf(place));
      const most = (values, least) => values.reduce((top, value) => Math.max(top, value), least);
      const lines = planes.length > 1 ? ink : [colour("trail")];
      const distances = planes.map((one) => Array.from(one.x, (x, place) => Math.hypot(x, one.y[place])));
      // A rigid wall stands at one; into a compliant one the rotor goes farther.
      const top = distances.reduce((found, one) => Math.max(found, most(one, 0) + 0.04), 1.06), impacts = joined(planes, "impact_times");
      parts.distances.data = { xs: planes.map(() => t), ys: distances, colour: lines };
      parts.impacts.data = { t: impacts.map((one) => time * one), r: impacts.map(() => top - 0.03), ...marks(joined(planes, "forward")) };
      parts.distances_x.setv({ start: 0, end });
      parts.distances_y.setv({ start: 0, end: top });
      for (const name of ["distances", "forces"]) if (plots[name]) plots[name].below[0].axis_label = `time (${message.time_unit})`;
      plots.section.left[0].axis_label = `radial speed (${message.speed_unit})`;
      parts.section_y.setv({ start: 0, end: 1.1 * message.speed * most(joined(planes, "impact_speeds"), 1e-3) });
      const spans = joined(planes, "spans"), all = (value) => spans.map(() => value);
      parts.spans.data = {
        left: spans.map((span) => time * span.start), right: spans.map((span) => time * span.end), bottom: all(0), top: all(top), colour: spans.map((span) => span.colour),
      };
      const kinds = new Map(spans.map((span) => [span.words, span.colour]));
      at("regimes").replaceChildren(...[...kinds].flatMap(([words, shade]) => {
        const key = document.createElement("i");
        key.className = "key"; key.style.background = shade;
        return [key, words];
      }));
      if (plots.forces) {
        const largest = planes.reduce((found, one) => most(one.force, found), 0), kilo = largest >= 1e4 ? 1e-3 : 1;
        parts.forces.data = { xs: planes.map(() => t), ys: planes.map((one) => Array.from(one.force, (force) => kilo * force)), colour: lines };
        parts.forces_x.setv({ start: 0, end });
        parts.forces_y.setv({ start: 0, end: 1.08 * kilo * (largest || 1) });
        plots.forces.left[0].axis_label = `contact force (${kilo < 1 ? "k" : ""}${planes[0].force_unit})`;
        at("forces-words").textContent = largest ? "" : "No contact.";
      }
      if (planes.length > 1) for (const place of document.querySelectorAll(".bearing-keys")) keys(place, planes.map((_, one) => [`touchdown bearing ${one + 1}`, inkOf(one), false]));
      carom.panels.shown("figures", message);
      carom.plots.now(carom.motion.now, true);
    }),
    now: (time, last) => {
      const clock = performance.now();
      if (!motion.message || (!last && clock - motion.drawn < 120)) return;
      motion.drawn = clock;
      for (const name of ["now", "now_too"]) if (parts[name]) parts[name].location = motion.message.time * time;
      section(time);
    },
    response: (message) => {
      if (message.refused) return;
      const { speeds, touchdowns, sensors, walls } = message, ends = [speeds[0], speeds[speeds.length - 1]];
      for (const [name, lines] of [["planes", touchdowns], ["sensors", sensors]]) {
        parts[name].data = { xs: lines.map(() => speeds), ys: lines, colour: lines.map((_, place) => inkOf(place)) };
      }
      parts.walls.data = { xs: walls.map(() => ends), ys: walls.map((one) => [one, one]) };
      parts.response_x.setv({ start: ends[0], end: ends[1] });
      parts.response_y.setv({ start: 0, end: message.top });
      parts.speed.location = message.speed;
      const named = (lines, words, dashed) => lines.map((_, place) => [`${words} ${place + 1}`, inkOf(place), dashed]);
      const above = walls[0] > message.top ? `, ${walls.map((one) => short(one, 3)).join(" and ")} µm: above the picture` : "";
      keys(at("response-keys"), [...named(touchdowns, "touchdown bearing", false), ...named(sensors, "sensors of bearing", true), [`clearance${above}`, colour("wall"), false]]);
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
  if (plots.diagram) carom.on("diagram", carom.plots.diagram);
  if (plots.response) carom.on("response", carom.plots.response);
  carom.showCursor = (name, value) => { if (name === along) parts.cursor.location = value; };
  if (carom.motion.message && !carom.motion.message.refused) carom.plots.motion(carom.motion.message);
};
