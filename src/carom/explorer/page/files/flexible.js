// A flexible machine: how it levitates, the motion at each touchdown bearing, and both over time and speed.
carom.follows = true; // a dragged slider waits for how the machine levitates, not for the picture of kicks
(() => {
  const row = (cells) => {
    const line = document.createElement("tr");
    line.append(...cells.map((text) => { const cell = document.createElement("td"); cell.textContent = text; return cell; }));
    return line;
  };
  const fill = (name, lines) => document.querySelector(`#${name} tbody`).replaceChildren(...lines);

  const pale = (what, old) => {
    carom.panels.pale(what, old);
    if (what === "basin") for (const name of ["basin", "sentence", "legend", "ring-note"]) at(name).classList.toggle("old", old);
  };
  carom.on("levitating", (message) => {
    carom.controls.arrived(message.number);
    // What contact does is pale until it is known of this machine.
    for (const what of ["motion", "figures", "basin", "told"]) if (carom.known[what] < message.number) pale(what, true);
    if (message.refused) { at("headline").textContent = message.refused; at("advice").textContent = ""; return; }
    at("headline").textContent = message.lead;
    at("advice").textContent = message.more;
    document.querySelector(".verdict").classList.toggle("bad", !message.holds);
    carom.panels.tile("damping", message.damping, message.damping_remark);
    carom.panels.tile("clear", message.clearance, message.clearance_remark);
    fill("whirls", message.whirls.map((one) => {
      const line = row([one.frequency, one.sense, one.damping]), bar = document.createElement("td"), drawn = document.createElement("i");
      bar.className = "ratio";
      drawn.style.width = `${Math.min(100, 100 * Math.sqrt(Math.abs(one.ratio)))}%`;
      bar.append(drawn);
      line.append(bar);
      line.classList.toggle("grows", one.ratio < 0);
      return line;
    }));
    fill("orbits", message.orbits.map((one) => row([one.place, one.radius, one.share])));
    at("orbits").hidden = !message.orbits.length;
  });

  carom.known = {};
  const know = (what, message) => {
    if (message.number < (carom.known[what] || 0)) return;
    carom.known[what] = message.number;
    pale(what, message.number < (carom.seen || 0));
  };
  carom.on("basin", (message) => {
    if (message.refused) { at("sentence").classList.remove("old"); return; }
    know("basin", message);
    carom.panels.tile("lost", message.lost, message.lost_remark);
  });
  carom.on("motion", (message) => {
    know("motion", message);
    const planes = message.planes || [];
    document.querySelectorAll("[data-bearing]").forEach((place) => {
      const found = planes[+place.dataset.bearing];
      place.textContent = found ? found.words : "";
    });
  });
  carom.on("told", (message) => {
    know("told", message);
    const told = Object.entries(message.told || { "Critical speeds": [message.refused] });
    at("told").replaceChildren(...told.flatMap(([heading, sentences]) => {
      const title = document.createElement("h4"), list = document.createElement("ul");
      title.textContent = heading;
      list.append(...sentences.map((words) => { const item = document.createElement("li"); item.textContent = words; return item; }));
      return [title, list];
    }));
  });
})();

// The figures with axes: the response over the speed, and distance and force at each touchdown bearing over time.
carom.begin_plots = (parts, plots) => {
  const colours = [carom.looks.stable, carom.looks.unstable, carom.looks["contact-free"], carom.looks.rub];
  const colourOf = (place) => colours[place % colours.length];
  const keys = (place, names) => place.replaceChildren(...names.map(([words, ink, dashed]) => {
    const entry = document.createElement("span"), key = document.createElement("i");
    key.className = `line${dashed ? " dashed" : ""}`;
    key.style.borderColor = ink;
    entry.append(key, words);
    return entry;
  }));
  for (const key of document.querySelectorAll("[data-colour]")) key.style.borderColor = colourOf(+key.dataset.colour);
  const theme = () => {
    const ink = carom.themed(plots);
    for (const name of ["now", "now_too"]) parts[name].line_color = ink;
    parts.cursor.line_color = colour("ink");
    for (const plot of Object.values(plots)) for (const one of plot.renderers) if (one.name === "wall") one.glyph.line_color = colour("wall");
    for (const one of plots.distances.center) if (one.name === "wall") one.line_color = colour("wall");
  };
  plots.response.below[0].axis_label = "speed (rpm)";
  plots.response.left[0].axis_label = "radius of the whirl (µm)";
  plots.distances.left[0].axis_label = "distance (of the clearance)";
  theme();
  carom.parts.push(theme);

  carom.on("levitating", carom.unhurried((message) => {
    if (message.refused) return;
    const { curves, speeds, walls } = message, many = curves.length / 2;
    const low = speeds.length ? speeds[0] : 0, high = speeds.length ? speeds[speeds.length - 1] : message.speed;
    const drawn = (dashed) => {
      const chosen = curves.map((one, place) => [one, colourOf(curves.slice(0, place).filter((other) => other.dashed === one.dashed).length)]).filter(([one]) => one.dashed === dashed);
      return { xs: chosen.map(() => speeds), ys: chosen.map(([one]) => one.radii), colour: chosen.map(([, ink]) => ink) };
    };
    parts.planes.data = drawn(false);
    parts.sensors.data = drawn(true);
    parts.walls.data = { xs: walls.map(() => [low, high]), ys: walls.map((one) => [one, one]) };
    parts.response_x.setv({ start: 0, end: high });
    parts.response_y.setv({ start: 0, end: message.top });
    parts.cursor.location = message.speed;
    const named = [false, true].flatMap((dashed) => curves.filter((one) => one.dashed === dashed).map((one, place) => [one.place, colourOf(place), dashed]));
    keys(at("response-keys"), [...named, ...(many ? [[`clearance${walls[0] > message.top ? `, ${walls.map((one) => short(one, 3)).join(" and ")} µm: above the picture` : ""}`, colour("wall"), false]] : [])]);
    at("response-words").textContent = curves.length ? "" : "There is none without an unbalance, or while a motion grows.";
  }));

  let shown = null, drawn = -1;
  carom.plots = {
    motion: carom.unhurried((message) => {
      shown = message;
      const { planes, time } = message, t = Array.from(message.times, (one) => time * one), ink = planes.map((_, place) => colourOf(place));
      const most = (values, least) => values.reduce((top, value) => Math.max(top, value), least);
      const distances = planes.map((one) => Array.from(one.x, (x, place) => Math.hypot(x, one.y[place])));
      const largest = planes.reduce((top, one) => most(one.force, top), 0), kilo = largest >= 1e4 ? 1e-3 : 1;
      parts.distances.data = { xs: planes.map(() => t), ys: distances, colour: ink };
      parts.forces.data = { xs: planes.map(() => t), ys: planes.map((one) => Array.from(one.force, (force) => kilo * force)), colour: ink };
      const end = t[t.length - 1];
      for (const name of ["distances_x", "forces_x"]) parts[name].setv({ start: 0, end });
      parts.distances_y.setv({ start: 0, end: distances.reduce((top, one) => Math.max(top, most(one, 0) + 0.04), 1.06) });
      parts.forces_y.setv({ start: 0, end: 1.08 * kilo * (largest || 1) });
      for (const plot of [plots.distances, plots.forces]) plot.below[0].axis_label = `time (${message.time_unit})`;
      plots.forces.left[0].axis_label = `contact force (${kilo < 1 ? "k" : ""}${planes[0].force_unit})`;
      keys(at("distances-keys"), planes.map((_, place) => [`touchdown bearing ${place + 1}`, colourOf(place), false]));
      keys(at("forces-keys"), planes.map((_, place) => [`touchdown bearing ${place + 1}`, colourOf(place), false]));
      at("forces-words").textContent = largest ? "" : "No contact.";
      carom.known.figures = message.number;
      carom.panels.shown("figures", message);
      carom.plots.now(carom.motion.now, true);
    }),
    now: (time, last) => {
      const clock = performance.now();
      if (!shown || (!last && clock - drawn < 120)) return;
      drawn = clock;
      for (const name of ["now", "now_too"]) parts[name].location = shown.time * time;
    },
  };
  if (carom.motion.message && !carom.motion.message.refused) carom.plots.motion(carom.motion.message);
};
