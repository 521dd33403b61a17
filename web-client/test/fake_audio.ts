// Web Audio without sound: counts nodes and keeps every value that a parameter is given.

export class FakeAudio {
  nowS = 0;
  nodeCount = 0;
  readonly values: number[] = [];
  readonly context: BaseAudioContext;
  private ranCount = 0;

  constructor() {
    const { values } = this;
    const param = () => {
      const note = (...given: number[]): void => void values.push(...given);
      return { value: 0, setTargetAtTime: note, setValueAtTime: note, exponentialRampToValueAtTime: note, cancelScheduledValues: note };
    };
    const node = (more: object = {}) => {
      ++this.nodeCount;
      return { connect: (next: unknown) => next, start: () => {}, ...more };
    };
    const owner = this;
    this.context = {
      sampleRate: 8000,
      get currentTime() {
        if (owner.ranCount++ === 0) owner.firstNodeCount = owner.nodeCount;
        return owner.nowS;
      },
      destination: {},
      createGain: () => node({ gain: param() }),
      createBiquadFilter: () => node({ frequency: param(), Q: param() }),
      createStereoPanner: () => node({ pan: param() }),
      createOscillator: () => node({ frequency: param() }),
      createBufferSource: () => node(),
      createWaveShaper: () => node(),
      createAnalyser: () => node(),
      createBuffer: (_: number, count: number) => ({ getChannelData: () => new Float32Array(count) }),
    } as unknown as BaseAudioContext;
  }

  /** Nodes when the time was asked for the first time. */
  firstNodeCount = 0;
}
