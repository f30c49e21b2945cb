// Plays the films of drops on the page: the rotor in its bearing in slow motion, with its readings.
//
// A film is a figure, hidden without this script, with its samples as JSON.
"use strict";

const playFilm = (figure) => {
  const film = JSON.parse(figure.querySelector('script[type="application/json"]').textContent);
  const one = (chosen) => figure.querySelector(chosen), all = (chosen) => [...figure.querySelectorAll(chosen)];
  const [rotor, clearance, arrow] = film.sizes, [ofTime, ofLength, ofForce, ofSpeed, ofImpulse] = film.units;
  const still = matchMedia("(prefers-reduced-motion: reduce)"), end = film.t[film.t.length - 1], flash = 0.03 * film.turn;
  const [play, slider, pace, springs] = [".play", ".time", ".pace", ".springs"].map(one);
  const readings = Object.fromEntries(all("[data-reading]").map((place) => [place.dataset.reading, place]));
  const parts = { ring: all(".ring, .overlap"), turning: one(".turning"), shaft: one(".shaft"), race: one(".race"), balls: one(".balls") };
  let now = film.t[film.poster], running = false, untouched = true, last = 0, waiting = 0;

  const sample = (time) => {
    let low = 0, high = film.t.length - 1;
    while (low < high - 1) { const middle = (low + high) >> 1; if (film.t[middle] <= time) low = middle; else high = middle; }
    return [low, Math.min(1, Math.max(0, (time - film.t[low]) / (film.t[high] - film.t[low] || 1)))];
  };
  const at = (name, [place, share]) => (film[name] ? film[name][place] + share * (film[name][place + 1] - film[name][place]) : 0);
  const format = (value, digits = 3) => {
    const text = Number((Math.abs(value) < 1e-3 ? 0 : value).toPrecision(digits)).toLocaleString("en", { maximumSignificantDigits: digits });
    return text.replace("-", "\u2212");
  };
  const degrees = (angle) => (-180 * angle) / Math.PI;
  const line = (x, y, along, up) => (Math.hypot(along, up) > 1 ? `M${x} ${-y}L${x + along} ${-y - up}` : "");

  // Impacts on a rigid wall stay for a moment.
  const current = () => film.impacts && film.impacts.findLast(([time]) => time <= now + 1e-4 && now < time + flash);

  const trail = (to) => {
    let [from] = sample(Math.max(0, now - film.turn)), path = "M";
    const every = Math.max(1, Math.floor((to - from) / 300));
    for (; from <= to; from += every) {
      const x = film.x[from] + (film.mx ? film.mx[from] : 0), y = film.y[from] + (film.my ? film.my[from] : 0);
      path += `${(clearance * x).toFixed(1)} ${(-clearance * y).toFixed(1)}L`;
    }
    return path;
  };

  const draw = () => {
    const here = sample(now), [mx, my] = [clearance * at("mx", here), clearance * at("my", here)];
    const [x, y] = [at("x", here), at("y", here)], radius = Math.hypot(x, y) || 1, [ex, ey] = [x / radius, y / radius];
    const [cx, cy] = [mx + clearance * x, my + clearance * y], [tx, ty] = [cx + rotor * ex, cy + rotor * ey];
    const impact = current(), [, n, f] = impact || [now, at("n", here), at("f", here)];
    for (const part of parts.ring) part.setAttribute("transform", `translate(${mx} ${-my})`);
    parts.shaft.setAttribute("transform", `translate(${cx} ${-cy})`);
    parts.turning.setAttribute("transform", `rotate(${degrees(at("a", here))})`);
    parts.race.setAttribute("transform", `rotate(${degrees(at("b", here))})`);
    if (parts.balls) parts.balls.setAttribute("transform", `rotate(${0.5 * degrees(at("b", here))})`);
    for (const part of all(".rotor-clip, .centre")) { part.setAttribute("cx", cx); part.setAttribute("cy", -cy); }
    if (springs) {
      const ends = springs.dataset.ends.split(",");
      [...springs.children].forEach((spring, number) => {
        const [c, s] = [Math.cos((number * Math.PI) / 4), Math.sin((number * Math.PI) / 4)], [inner, outer] = ends;
        spring.setAttribute("d", `M${outer * c} ${-outer * s}L${mx + inner * c} ${-my - inner * s}`);
      });
    }
    one(".trail").setAttribute("d", `${trail(here[0])}${cx} ${-cy}`);
    one(".arrow.normal").setAttribute("d", line(tx, ty, -arrow * n * ex, -arrow * n * ey));
    one(".arrow.friction").setAttribute("d", line(tx, ty, -arrow * f * ey, arrow * f * ex));
    tell(here, radius, impact);
  };

  const tell = (here, radius, impact) => {
    const held = film.held[here[0]] && film.held[here[0] + 1], gap = film.finer * (1 - radius), none = "\u2013";
    const [normal, friction, slip] = impact
      ? [film.hardest[0] * impact[1], film.hardest[1] * Math.abs(impact[2]), impact[3]]
      : [film.largest[0] * at("n", here), film.largest[1] * Math.abs(at("f", here)), at("v", here)];
    readings.time.textContent = `${format(now, 4)} ${ofTime}`;
    one('[data-name="gap"]').textContent = gap < 0 && !film.impacts ? "depth" : "gap";
    readings.gap.textContent = `${format(film.impacts ? Math.max(0, gap) : Math.abs(gap))} ${ofLength}`;
    readings.normal.textContent = held || impact ? `${format(normal)} ${impact ? ofImpulse : ofForce}` : none;
    readings.friction.textContent = held || impact ? `${format(friction)} ${impact ? ofImpulse : ofForce}` : none;
    readings.slip.textContent = held || impact ? `${format(slip)} ${ofSpeed}` : none;
    if (readings.race) readings.race.textContent = `${format(at("q", here))} ${ofSpeed}`;
    slider.value = Math.round((slider.max * now) / end);
    slider.setAttribute("aria-valuetext", readings.time.textContent);
  };

  const show = (time) => { now = Math.min(end, Math.max(0, time)); untouched = false; one(".still").hidden = true; draw(); };
  const halt = () => { running = false; clearTimeout(waiting); play.textContent = "Play"; };
  const toContact = (sense) => {
    const near = 1e-4 * film.turn;
    const next = sense > 0 ? film.peaks.find((time) => time > now + near) : film.peaks.findLast((time) => time < now - near);
    show(next ?? (sense > 0 ? end : 0));
  };
  const move = (clock) => {
    if (!running) return;
    show(now + ((clock - last) / 1000 / (film.seconds * pace.value)));
    last = clock;
    if (now >= end) halt(); else requestAnimationFrame(move);
  };
  // Who wants nothing to move is shown one contact after another.
  const leaf = () => {
    if (!running) return;
    toContact(1);
    if (now >= end) halt(); else waiting = setTimeout(leaf, 1200);
  };
  const begin = () => {
    if (untouched || now >= end) show(0);
    running = true;
    play.textContent = "Pause";
    last = performance.now();
    if (still.matches) waiting = setTimeout(leaf, 600); else requestAnimationFrame(move);
  };

  play.addEventListener("click", () => (running ? halt() : begin()));
  slider.addEventListener("input", () => { halt(); show((end * slider.value) / slider.max); });
  all(".step").forEach((button) => button.addEventListener("click", () => { halt(); toContact(+button.dataset.step); }));
  figure.addEventListener("keydown", (event) => {
    if (event.key !== " " || /^(BUTTON|SELECT)$/.test(event.target.tagName)) return;
    event.preventDefault();
    play.click();
  });

  figure.hidden = false;
  all("[hidden]").forEach((part) => { part.hidden = false; });
  draw();
};

document.querySelectorAll("[data-film]").forEach(playFilm);
