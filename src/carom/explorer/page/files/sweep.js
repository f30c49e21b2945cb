// Until somebody touches anything, damping moves slowly to and fro: a picture that moves says what the sliders are for.
carom.sweep = { state: "waiting" }; // then "moving", and "over" for ever

(() => {
  const still = window.matchMedia("(prefers-reduced-motion: reduce)"), wait = 2500, turn = 16000, turns = 2, pause = 140, reach = 0.24;
  const touches = ["pointerdown", "keydown", "wheel", "touchstart", "focusin", "input", "popstate"];
  const name = at("sweeping").dataset.moves; // none where motions take long
  let began = 0, from = 0, timer = 0;

  const over = () => {
    if (carom.sweep.state === "over") return;
    const moving = carom.sweep.state === "moving";
    carom.sweep.state = "over";
    clearTimeout(timer);
    for (const touch of touches) window.removeEventListener(touch, over, true);
    window.removeEventListener("pointermove", hovered, true);
    document.removeEventListener("visibilitychange", over);
    if (!moving) return;
    at("sweeping").hidden = true;
    carom.controls.glide(name, null);
  };
  // A mouse that lies still sends a first move too.
  let first = null;
  const hovered = (event) => {
    first ||= event;
    if (Math.hypot(event.clientX - first.clientX, event.clientY - first.clientY) > 6) over();
  };
  const move = () => {
    const time = performance.now() - began;
    if (time > turns * turn) { over(); return; }
    carom.controls.glide(name, clamp(from + reach * Math.sin((2 * Math.PI * time) / turn), 0, 1));
    timer = setTimeout(move, pause);
  };
  const begin = () => {
    if (!name || document.hidden || still.matches || location.hash) { over(); return; }
    carom.sweep.state = "moving";
    at("sweeping").hidden = false;
    from = carom.controls.share(name);
    began = performance.now();
    move();
  };
  // Once all that was asked for is there.
  carom.sweep.idle = () => { if (carom.sweep.state === "waiting" && !timer) timer = setTimeout(begin, wait); };
  for (const touch of touches) window.addEventListener(touch, over, true);
  window.addEventListener("pointermove", hovered, true);
  document.addEventListener("visibilitychange", over);
})();
