// The plane of disturbances on a canvas: cells coloured by where they lead, rings, and the disturbances that are drawn.
//
//     const picture = basinPicture(canvas, { onPoint, onRing });
//     picture.show(message);        // cells, size, largest, unit, axes, endings, contact_free, required, outward
//     picture.mark(kicks, active);  // pairs { first, second } in the unit of the message
//     picture.setRing(size);        // in this unit; 0 for none
//     picture.prove(proven);        // number of the message that it belongs to, open (n by n): pale where nothing is proven
//
// onPoint(kick, chosen) hears where one points, onRing(size, done) to which size the ring is dragged.
import { clamp, inksOf, short, square, tickStep, tile } from "./common.js";

export const basinPicture = (canvas, { onPoint = () => {}, onRing = () => {} } = {}) => {
  const ink = inksOf(canvas), knobAngle = -0.6, narrow = 300;
  const picture = { message: null, kicks: [], active: 0, ring: 0, proven: null };
  let frame = null, layer = null, veil = null, dragged = false, dragging = false;

  // Cells with their textures in pixels of the screen, painted once for a picture and a size.
  const paint = (message, wide) => {
    const n = message.size, image = new ImageData(wide, wide), pixels = new Uint32Array(image.data.buffer);
    const cell = Array.from({ length: wide }, (_, place) => Math.floor(((place + 0.5) * n) / wide));
    const tiles = message.endings.map((one) => tile(one.colour, one.hatch));
    for (let row = 0; row < wide; row += 1) {
      const below = (n - 1 - cell[row]) * n;
      for (let column = 0; column < wide; column += 1) {
        const made = tiles[message.cells[below + cell[column]]];
        if (made) pixels[row * wide + column] = made.pixels[(row % made.side) * made.side + (column % made.side)];
      }
    }
    const sheet = document.createElement("canvas");
    sheet.width = sheet.height = wide;
    sheet.getContext("2d").putImageData(image, 0, 0);
    return { message, sheet };
  };

  // Paper over what is not proven, which lets a third of the colours through.
  const veilOf = (open) => {
    const n = Math.round(Math.sqrt(open.length)), image = new ImageData(n, n), sheet = document.createElement("canvas");
    open.forEach((left, place) => { image.data[4 * ((n - 1 - Math.floor(place / n)) * n + place % n) + 3] = left ? 165 : 0; });
    sheet.width = sheet.height = n;
    const pen = sheet.getContext("2d");
    pen.putImageData(image, 0, 0);
    pen.globalCompositeOperation = "source-in";
    pen.fillStyle = ink("card");
    pen.fillRect(0, 0, n, n);
    return sheet;
  };

  // Lines that are seen on light and on dark cells.
  const twice = (pen, draw, [wide, thin], [under, over]) => {
    for (const [line, colour] of [[wide, under], [thin, over]]) { pen.lineWidth = line; pen.strokeStyle = colour; draw(); }
  };
  const written = (pen, words, x, y) => {
    pen.lineWidth = 3; pen.strokeStyle = "rgba(0,0,0,.75)"; pen.fillStyle = "#fff";
    pen.strokeText(words, x, y); pen.fillText(words, x, y);
  };

  const rings = (pen, message, circle, span, small) => {
    const step = tickStep(message.largest, small ? 2 : 3);
    for (let size = step; size <= message.largest; size += step) twice(pen, () => circle(size / message.largest), [1.8, 0.8], ["rgba(0,0,0,.2)", "rgba(255,255,255,.5)"]);
    if (message.contact_free > 0) {
      pen.setLineDash([5, 4]);
      twice(pen, () => circle(message.contact_free), [1.6, 1.6], ["rgba(0,0,0,.6)", "rgba(0,0,0,.6)"]);
      pen.setLineDash([]);
    }
    if (message.required > 0 && message.required <= message.largest * 1.0001) {
      const share = Math.min(message.required / message.largest, 1 - 2.5 / span);
      twice(pen, () => circle(share), [5, 2.4], ["rgba(255,255,255,.85)", "#111111"]);
    }
    if (picture.ring > 0 && picture.ring <= message.largest) {
      const share = picture.ring / message.largest, [x, y] = frame.at(share * Math.cos(knobAngle), share * Math.sin(-knobAngle));
      twice(pen, () => circle(share), [4.5, 2.2], ["rgba(255,255,255,.9)", "#c2410c"]);
      pen.fillStyle = "#c2410c"; pen.strokeStyle = "#fff"; pen.lineWidth = 2;
      pen.beginPath(); pen.arc(x, y, 7, 0, 7); pen.fill(); pen.stroke();
    }
  };

  const kicks = (pen) => {
    picture.kicks.forEach((kick, place) => {
      const [x0, y0] = frame.at(0, 0), [x, y] = frame.of(kick);
      twice(pen, () => { pen.beginPath(); pen.moveTo(x0, y0); pen.lineTo(x, y); pen.stroke(); }, [4, 2], ["rgba(0,0,0,.65)", "#fff"]);
      pen.fillStyle = place === picture.active ? "#fff" : "#e4e7ea"; pen.strokeStyle = "rgba(0,0,0,.75)"; pen.lineWidth = place === picture.active ? 2.5 : 1.2;
      pen.beginPath(); pen.arc(x, y, 8, 0, 7); pen.fill(); pen.stroke();
      pen.fillStyle = "#111"; pen.font = "700 11px system-ui, sans-serif"; pen.textAlign = "center"; pen.textBaseline = "middle";
      if (picture.kicks.length > 1) pen.fillText(String(place + 1), x, y + 0.5);
    });
  };

  const axes = (pen, message, side, small) => {
    const { x0, y0, span } = frame, step = tickStep(message.largest, 3);
    pen.fillStyle = ink("soft"); pen.font = "12px system-ui, sans-serif";
    if (small) {
      pen.textAlign = "left"; pen.textBaseline = "alphabetic"; pen.font = "10px system-ui, sans-serif";
      pen.fillText(`± ${short(message.largest, 3)} ${message.unit}`, 2, side - 3);
      return;
    }
    for (let value = -Math.floor(message.largest / step) * step; value <= message.largest; value += step) {
      const [x, y] = frame.at(value / message.largest, value / message.largest), words = short(value, 3);
      pen.textAlign = "center"; pen.textBaseline = "top"; pen.fillText(words, clamp(x, x0 + 8, side - 14), y0 + span + 4);
      pen.textAlign = "right"; pen.textBaseline = "middle"; pen.fillText(words, x0 - 5, clamp(y, y0 + 6, y0 + span - 6));
    }
    pen.textAlign = "center"; pen.textBaseline = "alphabetic";
    pen.fillText(`${message.axes[0]} (${message.unit})`, x0 + span / 2, y0 + span + 32);
    pen.save(); pen.translate(11, y0 + span / 2); pen.rotate(-Math.PI / 2); pen.fillText(`${message.axes[1]} (${message.unit})`, 0, 0); pen.restore();
  };

  picture.draw = () => {
    const message = picture.message, [pen, side] = square(canvas), small = side < narrow;
    const left = small ? 2 : 54, below = small ? 14 : 40, edge = small ? 2 : 6;
    const x0 = left, y0 = edge, span = Math.min(side - left - edge, side - below - edge);
    const at = (first, second) => [x0 + span * (first + 1) / 2, y0 + span * (1 - second) / 2];
    frame = { x0, y0, span, at, of: (kick) => at(kick.first / message.largest, kick.second / message.largest) };
    pen.clearRect(0, 0, side, side);
    const circle = (share) => { pen.beginPath(); pen.arc(...at(0, 0), span * share / 2, 0, 7); pen.stroke(); };
    if (!message) {
      pen.fillStyle = ink("void"); pen.beginPath(); pen.arc(...at(0, 0), span / 2, 0, 7); pen.fill();
      return;
    }
    const wide = Math.round(span * (canvas.width / side));
    if (layer === null || layer.message !== message || layer.sheet.width !== wide) layer = paint(message, wide);
    pen.imageSmoothingEnabled = false;
    pen.drawImage(layer.sheet, x0, y0, span, span);
    if (picture.veiled()) pen.drawImage((veil ||= veilOf(picture.proven.open)), x0, y0, span, span);
    // The edge of the disc, which dark cells would not have on dark paper.
    pen.strokeStyle = ink("soft"); pen.lineWidth = 1; circle(1);
    pen.save();
    pen.beginPath(); pen.rect(x0, y0, span, span); pen.clip();
    rings(pen, message, circle, span, small);
    // From where angles count: the x axis that turns with the shaft, as on the command line.
    const [across, up] = [message.outward[0], -message.outward[1]];
    twice(pen, () => { pen.beginPath(); pen.moveTo(...at(0.92 * across, 0.92 * up)); pen.lineTo(...at(across, up)); pen.stroke(); }, [4, 2], ["rgba(0,0,0,.65)", "#fff"]);
    pen.font = "600 12px system-ui, sans-serif"; pen.textAlign = "center"; pen.textBaseline = "middle";
    if (!small) written(pen, "0°", ...at(0.84 * across, 0.84 * up));
    kicks(pen);
    pen.restore();
    axes(pen, message, side, small);
  };

  picture.show = (message) => { picture.message = message; picture.draw(); };
  picture.mark = (marked, active = picture.active) => { picture.kicks = marked; picture.active = active; picture.draw(); };
  picture.setRing = (size) => { picture.ring = size; picture.draw(); };
  picture.prove = (proven) => { picture.proven = proven; veil = null; picture.draw(); };
  picture.veiled = () => picture.proven !== null && picture.message !== null && picture.proven.number === picture.message.number;
  picture.renew = () => { ink.renew(); veil = null; picture.draw(); };
  // Where the cell of a disturbance leads; null outside the picture.
  picture.endingOf = (kick) => {
    const message = picture.message, n = message.size;
    const [column, row] = [kick.first, kick.second].map((part) => Math.floor((part / message.largest + 1) * n / 2));
    return (column >= 0 && row >= 0 && column < n && row < n && message.endings[message.cells[row * n + column]]) || null;
  };
  // Share of the cells up to a size that come back, and their number.
  picture.shareWithin = (size) => {
    const message = picture.message, n = message.size;
    let back = 0, all = 0;
    message.cells.forEach((cell, place) => {
      const first = 2 * (place % n + 0.5) / n - 1, second = 2 * (Math.floor(place / n) + 0.5) / n - 1;
      if (cell >= message.endings.length || Math.hypot(first, second) * message.largest > size) return;
      all += 1;
      back += message.endings[cell].back ? 1 : 0;
    });
    return [all ? back / all : 1, all];
  };

  const kickAt = (event) => {
    if (!frame || !picture.message) return null;
    const box = canvas.getBoundingClientRect(), { largest } = picture.message;
    const first = 2 * (event.clientX - box.left - frame.x0) / frame.span - 1, second = 1 - 2 * (event.clientY - box.top - frame.y0) / frame.span;
    return { first: largest * first, second: largest * second, share: Math.hypot(first, second) };
  };
  const point = (event, chosen) => {
    const kick = kickAt(event);
    if (kick && kick.share <= 1) onPoint({ first: kick.first, second: kick.second }, chosen);
  };
  // The ring is held at its knob with a finger, anywhere with a mouse.
  const holds = (event) => {
    const kick = kickAt(event);
    if (!kick || !(picture.ring > 0)) return false;
    const share = picture.ring / picture.message.largest, [x, y] = frame.at(share * Math.cos(knobAngle), share * Math.sin(-knobAngle));
    const box = canvas.getBoundingClientRect(), apart = Math.hypot(event.clientX - box.left - x, event.clientY - box.top - y);
    const touch = event.pointerType === "touch" || event.pointerType === undefined;
    return apart < (touch ? 22 : 11) || (!touch && Math.abs(kick.share - share) * frame.span / 2 < 4);
  };
  canvas.addEventListener("touchstart", (event) => { if (event.touches.length === 1 && holds(event.touches[0])) event.preventDefault(); }, { passive: false });
  canvas.addEventListener("pointerdown", (event) => {
    dragged = false;
    dragging = holds(event);
    if (dragging) canvas.setPointerCapture(event.pointerId);
  });
  const pull = (event, done) => {
    const kick = kickAt(event);
    picture.setRing(clamp(kick.share, 0.01, 1) * picture.message.largest);
    onRing(picture.ring, done);
  };
  canvas.addEventListener("pointermove", (event) => {
    if (dragging) { dragged = true; pull(event, false); return; }
    const held = holds(event);
    canvas.style.cursor = held ? "grab" : "";
    if (!held && event.pointerType !== "touch" && event.buttons <= 1) point(event, false);
  });
  for (const end of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(end, (event) => {
      if (dragging && dragged && end === "pointerup") pull(event, true);
      dragging = false;
    });
  }
  canvas.addEventListener("click", (event) => { if (!dragged) point(event, true); });
  canvas.addEventListener("keydown", (event) => {
    const message = picture.message, move = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    const pulled = { "+": 0.02, "-": -0.02 }[event.key];
    if (!message || (!move && !pulled) || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    if (pulled) {
      picture.setRing(clamp((picture.ring || message.largest / 2) + pulled * message.largest, 0.01 * message.largest, message.largest));
      onRing(picture.ring, true);
      return;
    }
    const kick = picture.kicks[picture.active] || { first: 0, second: 0 };
    const [first, second] = [kick.first + 0.02 * message.largest * move[0], kick.second + 0.02 * message.largest * move[1]];
    if (Math.hypot(first, second) <= message.largest) onPoint({ first, second }, true, picture.active);
  });
  return picture;
};
