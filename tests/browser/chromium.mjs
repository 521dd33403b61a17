// Which Chromium, and its flags: software WebGL, no traffic of its own.
export const executable = process.env.CHROMIUM ?? "/usr/bin/chromium";
export const kChromiumArgs = [
  "--no-sandbox",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
];
