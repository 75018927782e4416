// Types of the page's JavaScript, for tsc alone: tests/living/test_types.py checks the modules as they stand in the page.

/** A point, a vector or a direction: [x, y]. */
type Z = [number, number];
type OfOne = (a: number[]) => Z;
type OfTwo = (a: number[], b: number[]) => Z;
type Large = (...numbers: bigint[]) => bigint;

/** What a program of the record gives at a crank angle, part by part. */
type Parts = number[];

/** The plans of a linkage, written as JavaScript by the page's maker. */
declare const PROGRAMS: Record<string, (inputs: unknown[], constants: unknown[], primitives: Record<string, Function>) => Parts>;

/** vendor/lean-qr.js */
declare const QR: { generate(text: string): { size: number, get(x: number, y: number): boolean } };

/** vendor/webm-muxer.js */
declare const WEBM: {
  ArrayBufferTarget: new () => { buffer: ArrayBuffer },
  Muxer: new (options: object) => { target: { buffer: ArrayBuffer }, addVideoChunk(chunk: EncodedVideoChunk, told?: EncodedVideoChunkMetadata): void, finalize(): void },
};

interface Window { tmm: Record<string, unknown> }
