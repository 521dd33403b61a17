// Placeholder.
import type { App } from "./app";

export function openProjector(_app: App): void {}
