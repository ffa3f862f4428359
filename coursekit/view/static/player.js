// Playing a motion that was sent once: buttons, a scrubber and speeds, all stepped here in the page.

// show(k) draws frame k of the motion; report(k, playing) tells the kernel, which shows the same; wake() asks for
// animation frames.
function makePlayer({ show, report, wake }) {
  const play = operated("button", { type: "button", class: "ck-button ck-play" }, "play");
  const back = operated("button", { type: "button", class: "ck-button", title: "to the first pose" }, "restart");
  const scrub = operated("input", { type: "range", class: "ck-scrub", min: 0, step: 1, "aria-label": "pose along the motion" });
  const speed = operated("select", { class: "ck-button", "aria-label": "playing speed" }, ...[0.1, 0.25, 0.5, 1, 2].map((factor) => element("option", { value: factor }, `${factor} x`)));
  const loop = operated("input", { type: "checkbox" });
  const count = element("span", { class: "ck-count" });
  const bar = operated("div", { class: "ck-player", role: "group", "aria-label": "motion" });
  bar.append(play, back, scrub, count, speed, element("label", { class: "ck-loop" }, loop, "repeat"));

  let motion = null; // {frames, fps}
  let frame = 0, playing = false, due = 0, last = null;

  const follow = (k) => {
    frame = k;
    scrub.value = k;
    scrub.setAttribute("aria-valuetext", `pose ${k + 1} of ${motion.frames}`);
    count.textContent = `${k + 1} / ${motion.frames}`;
    show(k);
  };
  const go = (k) => {
    follow(k);
    report(k, playing);
  };
  const mark = (on) => {
    playing = on;
    play.textContent = on ? "pause" : "play";
    play.setAttribute("aria-label", on ? "pause the motion" : "play the motion");
  };
  const setPlaying = (on) => {
    mark(on);
    [last, due] = [null, 0];
    if (on) wake();
    else if (motion) report(frame, false);
  };
  const step = (k) => {
    if (!motion) return;
    mark(false);
    go(Math.max(0, Math.min(motion.frames - 1, k)));
  };

  play.onclick = () => {
    if (!playing && frame >= motion.frames - 1) go(0);
    setPlaying(!playing);
  };
  back.onclick = () => step(0);
  scrub.oninput = () => step(Number(scrub.value));
  scrub.addEventListener("keydown", (event) => {
    if (event.key !== " ") return;
    event.preventDefault();
    play.click();
  });

  return {
    bar,
    playing: () => playing,
    loaded: () => Boolean(motion),
    frame: () => frame,
    // a new motion, or null for none; at = the frame to rest at, or play from the start
    load(next, at = null) {
      motion = next && next.frames ? next : null;
      bar.hidden = !motion;
      if (!motion) return mark(false);
      scrub.max = motion.frames - 1;
      speed.value = "1";
      loop.checked = !!motion.loop;
      const still = matchMedia("(prefers-reduced-motion: reduce)").matches; // then the end is shown at once
      mark(false);
      if (at !== null) return follow(Math.max(0, Math.min(motion.frames - 1, at)));
      if (!motion.autoplay) return follow(0);
      if (still) return go(motion.frames - 1);
      mark(true);
      go(0);
      setPlaying(true);
    },
    // another view of the same model, or the kernel, shows frame k
    follow: (k) => motion && !playing && k !== frame && follow(k),
    step,
    toggle: () => motion && play.click(),
    // Once per animation frame. Shows every pose as long as it is less than a second late; then it keeps up with time.
    tick(now) {
      if (!playing) return;
      const perSecond = motion.fps * Number(speed.value);
      if (last !== null) due += ((now - last) / 1000) * perSecond;
      last = now;
      if (due < 1) return;
      const jump = Math.max(1, Math.floor(due - perSecond));
      due -= jump;
      const next = frame + jump;
      if (next < motion.frames) go(next);
      else if (loop.checked) go(next % motion.frames);
      else { // the last pose is always drawn, exactly
        mark(false);
        go(motion.frames - 1);
      }
    },
  };
}
