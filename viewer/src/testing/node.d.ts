// Declares the parts of node that the tests use, so that they do not need node's own types.
declare module 'node:test' {
    export default function test(name: string, body: () => void | Promise<void>): void;
}
declare module 'node:assert/strict' {
    interface Assert {
        (value: unknown, message?: string): asserts value;
        equal(actual: unknown, expected: unknown, message?: string): void;
        deepEqual(actual: unknown, expected: unknown, message?: string): void;
        throws(body: () => unknown, expected?: RegExp | (new (...args: never[]) => Error), message?: string): void;
        ok(value: unknown, message?: string): asserts value;
    }
    const assert: Assert;
    export default assert;
}
declare module 'node:child_process' {
    export function execFileSync(program: string, words: string[], options: { encoding: 'utf8' }): string;
    export function spawnSync(
        program: string,
        words: string[],
        options?: { encoding: 'utf8' },
    ): { status: number | null; stdout: string; error?: Error };
}
declare module 'node:fs' {
    export function mkdtempSync(prefix: string): string;
    export function rmSync(path: string, options: { recursive: boolean }): void;
    export function writeFileSync(path: string, text: string): void;
}
declare module 'node:os' {
    export function tmpdir(): string;
}
declare module 'node:path' {
    export function join(...parts: string[]): string;
}
declare module 'node:process' {
    export function exit(status: number): never;
}
