// Words and numbers: state, tiles of the picture, texts to copy, and whether the server is still there.
carom.panels = { exports: null };

(() => {
  let compiling = 0;
  const endless = (words) => { at("state").className = "busy endless"; at("state").querySelector("span").textContent = words; };
  carom.on("state", (state) => {
    const box = at("state");
    clearInterval(compiling);
    at("cancel").hidden = state.kind !== "working";
    at("resume").hidden = state.kind !== "cancelled";
    if (state.kind === "compiling") {
      const began = performance.now();
      const say = () => {
        const seconds = Math.round((performance.now() - began) / 1000);
        endless(seconds < 8 ? "Loading the kernels …" : `Compiling the kernels. This is done once, and takes a minute or two: ${seconds} s`);
      };
      say();
      compiling = setInterval(say, 1000);
    } else if (state.kind === "working") {
      box.className = "busy";
      box.querySelector("i").style.width = `${Math.max(3, 100 * state.share)}%`;
      box.querySelector("span").textContent = state.words;
    } else {
      box.className = "";
      box.querySelector("span").textContent = state.kind === "cancelled" ? "Stopped. What had been found is shown." : "";
      if (state.kind === "idle" && carom.idle) carom.idle();
    }
  });
  for (const wish of ["cancel", "resume"]) at(wish).addEventListener("click", () => { carom.requests[wish] += 1; });

  const tile = (name, value, remark) => {
    at(name).textContent = value;
    at(`${name}-remark`).textContent = remark;
  };
  carom.panels.tile = tile;
  // What does not come with the picture belongs to one machine: it is pale until it is known of the present one.
  carom.panels.pale = (what, old) => { for (const card of document.querySelectorAll(`[data-of="${what}"]`)) card.classList.toggle("old", old); };
  carom.panels.shown = (what, message) => carom.panels.pale(what, message.number < (carom.seen || 0));
  carom.on("basin", (message) => {
    if (message.refused) return;
    at("sentence").textContent = message.sentence;
    tile("share", message.share, message.share_remark);
    at("lost-title").textContent = `smallest ${message.nouns[0]} that does not come back`;
  });
  carom.on("exports", (message) => { carom.panels.exports = message; });

  const words = { toml: "machine file", options: "list of command-line options", command: "command", python: "program", link: "address of this machine and these kicks" };
  for (const button of document.querySelectorAll("[data-copy]")) {
    button.addEventListener("click", async () => {
      const text = button.dataset.copy === "link" ? location.href : carom.panels.exports ? carom.panels.exports[button.dataset.copy] : "";
      const place = at("copy-text");
      if (!text) { at("copied").textContent = button.dataset.copy === "command" ? "No command-line option describes this start: copy the program instead." : "Nothing differs from the file."; return; }
      place.value = text;
      try {
        await navigator.clipboard.writeText(text);
        place.hidden = true;
        at("copied").textContent = `The ${words[button.dataset.copy]} is in the clipboard.`;
      } catch {
        place.hidden = false;
        place.select();
        at("copied").textContent = `The browser does not allow copying: the ${words[button.dataset.copy]} is selected below.`;
      }
    });
  }

  // Without its connection, or with another server in its place, the page begins again as soon as a server answers.
  let server = "", lost = false;
  carom.panels.lost = () => { lost = true; };
  const look = async () => {
    try {
      const found = await (await fetch("alive", { cache: "no-store" })).json();
      if (lost || (server && found.server !== server)) { location.reload(); return; }
      server = found.server;
      at("gone").hidden = true;
    } catch {
      at("gone").hidden = false;
      at("gone").textContent = "The server has stopped. This page reconnects as soon as it runs again; your settings are kept.";
    }
    setTimeout(look, 1500);
  };
  carom.panels.watch = look;
})();
