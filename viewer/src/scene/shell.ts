// Quotes words of a command for a POSIX shell.

const plain = /^[A-Za-z0-9_.,:/=+-]+$/;

// Returns the word in a form that the shell reads as exactly this word.
export const quoted = (word: string): string => (plain.test(word) ? word : `'${word.replace(/'/g, "'\\''")}'`);

// Returns false for a word with control or formatting characters, which a terminal may obey before its shell reads
// them.
export const isPrintable = (word: string): boolean =>
    !/[\u0000-\u001f\u007f-\u009f\u200b-\u200f\u2028-\u202e\u2066-\u2069]/.test(word);
