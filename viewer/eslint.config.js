import tseslint from 'typescript-eslint';

export default tseslint.config(
    ...tseslint.configs.strictTypeChecked,
    ...tseslint.configs.stylisticTypeChecked,
    {
        files: ['src/**/*.ts'],
        languageOptions: { parserOptions: { project: './tsconfig.json' } },
        linterOptions: { reportUnusedDisableDirectives: 'error' },
        rules: {
            // Allow "!" after an index or a call, where the code around it knows that there is a value. Otherwise loops
            // over typed arrays would need checks that never fail. Refuse "!" after a name, where it hides a case.
            '@typescript-eslint/no-non-null-assertion': 'off',
            'no-restricted-syntax': [
                'error',
                {
                    selector:
                        'TSNonNullExpression > Identifier, TSNonNullExpression > MemberExpression[computed=false]',
                    message: 'Narrow the type instead of writing "!" after a name.',
                },
            ],
            // States of cells and kinds of bricks are numbers of a format, which typed arrays hold.
            '@typescript-eslint/no-unsafe-enum-assignment': 'off',
            '@typescript-eslint/no-unsafe-enum-comparison': 'off',
            // This rule would remove the "!" of "counts[i]! += 1", which TypeScript needs.
            '@typescript-eslint/no-unnecessary-type-assertion': 'off',
            // Allow callbacks in one line, and "return this.fail()", which shows that the function ends there.
            '@typescript-eslint/no-confusing-void-expression': 'off',
            // Allow "||" for texts, where an empty text counts as missing.
            '@typescript-eslint/prefer-nullish-coalescing': ['error', { ignorePrimitives: { string: true } }],
            // Allow numbers in template strings.
            '@typescript-eslint/restrict-template-expressions': ['error', { allowNumber: true }],
        },
    },
    {
        // Allow any "!" in tests, because a wrong "!" makes the test fail.
        files: ['src/**/*.test.ts', 'src/testing/*.ts'],
        rules: {
            'no-restricted-syntax': 'off',
            // Allow async functions without await, which replace a server, and arrays in the messages of failures.
            '@typescript-eslint/require-await': 'off',
            '@typescript-eslint/restrict-template-expressions': ['error', { allowNumber: true, allowArray: true }],
        },
    },
);
