// Words of a command for a POSIX shell.

const plain = /^[A-Za-z0-9_.,:/=+-]+$/;

// A word that the shell takes as it is, whatever is in it.
export const quoted = (word: string): string => (plain.test(word) ? word : `'${word.replace(/'/g, "'\\''")}'`);

// A terminal may obey control characters before its shell reads the word.
export const isPrintable = (word: string): boolean =>
    !/[\u0000-\u001f\u007f-\u009f\u200b-\u200f\u2028-\u202e\u2066-\u2069]/.test(word);
