// What the tests use of node, whose types are a package of their own.
declare module 'node:test' {
    export default function test(name: string, body: () => void | Promise<void>): void;
}
declare module 'node:assert/strict' {
    interface Assert {
        (holds: unknown, message?: string): asserts holds;
        equal(actual: unknown, expected: unknown, message?: string): void;
        deepEqual(actual: unknown, expected: unknown, message?: string): void;
        throws(body: () => unknown, expected?: unknown, message?: string): void;
    }
    const assert: Assert;
    export default assert;
}
