// The address keeps what was set and which kicks are drawn: it can be sent to a colleague, survives a restart of the server, and each
// step of it can be undone, also with the browser's own way back.
carom.address = {};

(() => {
  const machine = at("controls").dataset.machine, views = ["show", "range", "kick", "other", "ring", "frame"];
  const depth = () => (history.state && history.state.depth) || 0;
  const update = () => at("undo").toggleAttribute("disabled", depth() === 0);

  const fragment = () => {
    const parts = { ...carom.controls.settings, ...carom.stage.kept() };
    return Object.keys(parts).length ? `#${new URLSearchParams({ of: machine, ...parts })}` : "";
  };
  carom.address.keep = (anew = true) => {
    const words = fragment();
    if (words === location.hash) return;
    if (anew) history.pushState({ depth: depth() + 1 }, "", words || location.pathname);
    else history.replaceState({ depth: depth() }, "", words || location.pathname);
    update();
  };

  const read = () => {
    const kept = new URLSearchParams(location.hash.slice(1));
    if ((kept.get("of") || machine) !== machine) {
      carom.controls.notice = "The address contains values for another machine; they are ignored.";
      for (const name of [...kept.keys()]) kept.delete(name);
    }
    const texts = Object.fromEntries([...kept].filter(([name]) => name !== "of" && !views.includes(name)));
    carom.controls.replace(texts);
    carom.stage.restore(Object.fromEntries([...kept].filter(([name]) => views.includes(name))));
    carom.controls.ask(false, false);
    update();
  };
  carom.address.begin = () => { read(); carom.address.keep(false); update(); };
  window.addEventListener("popstate", read);
  const undo = () => { if (depth() > 0) history.back(); };
  at("undo").addEventListener("click", undo);
  // In a box the browser undoes what is typed.
  document.addEventListener("keydown", (event) => {
    if (event.key !== "z" || !(event.ctrlKey || event.metaKey) || event.shiftKey || event.target.matches(".box, textarea")) return;
    event.preventDefault();
    undo();
  });
})();
