import tseslint from 'typescript-eslint';

export default tseslint.config(
    ...tseslint.configs.strictTypeChecked,
    ...tseslint.configs.stylisticTypeChecked,
    {
        files: ['src/**/*.ts'],
        languageOptions: { parserOptions: { project: './tsconfig.json' } },
        linterOptions: { reportUnusedDisableDirectives: 'error' },
        rules: {
            // A "!" may follow an index or a call, if the code around it knows that the answer is there: loops over
            // typed arrays would be full of checks that never fail. After a name it hides a case.
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
            // "counts[i]! += 1" needs its "!", which this rule does not see.
            '@typescript-eslint/no-unnecessary-type-assertion': 'off',
            // A callback in one line is easy to read, and "return this.fail()" says that nothing follows.
            '@typescript-eslint/no-confusing-void-expression': 'off',
            // An empty text is no answer, either.
            '@typescript-eslint/prefer-nullish-coalescing': ['error', { ignorePrimitives: { string: true } }],
            // Numbers in texts are usual.
            '@typescript-eslint/restrict-template-expressions': ['error', { allowNumber: true }],
        },
    },
    {
        // A wrong "!" ends a test, which is what a test is for.
        files: ['src/**/*.test.ts', 'src/testing/*.ts'],
        rules: {
            'no-restricted-syntax': 'off',
            // What stands in for a server answers later, and a failure shows a place.
            '@typescript-eslint/require-await': 'off',
            '@typescript-eslint/restrict-template-expressions': ['error', { allowNumber: true, allowArray: true }],
        },
    },
);
