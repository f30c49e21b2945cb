// What the parts of the page share.
const carom = { looks: window.carom_looks, parts: [], requests: null, begun: null };
const at = (id) => document.getElementById(id);
const colour = inksOf(document.documentElement);

// Which part of the page shows an answer.
carom.shows = {};
carom.on = (name, show) => { (carom.shows[name] ||= []).push(show); };

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
carom.redraw = () => { colour.renew(); for (const part of carom.parts) part(); };
for (const query of [dark, paper]) query.addEventListener("change", () => requestAnimationFrame(carom.redraw));
window.addEventListener("beforeprint", () => carom.redraw());
window.addEventListener("resize", carom.throttled(60, () => carom.redraw()));

// Axes of figures in the colours of the page; returns that of their labels.
carom.themed = (plots) => {
  const ink = colour("soft"), rule = colour("rule");
  for (const plot of Object.values(plots)) {
    plot.setv({ border_fill_color: colour("card"), background_fill_color: colour("card"), border_fill_alpha: 1, background_fill_alpha: 1 });
    for (const axis of [...plot.below, ...plot.left]) {
      axis.setv({ axis_label_text_color: ink, major_label_text_color: ink, axis_line_color: rule, major_tick_line_color: rule, minor_tick_line_color: null,
        axis_label_text_font_style: "normal", axis_label_text_font_size: "12px", major_label_text_font_size: "12px" });
    }
    for (const grid of plot.center) if (grid.grid_line_color !== undefined) grid.grid_line_color = rule;
  }
  return ink;
};
