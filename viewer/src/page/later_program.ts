// Loads a program that the first picture does not need. The server has it at view/NAME.js.

import { address } from '../wire/api';

export async function laterProgram<Program>(name: 'editor' | 'layers' | 'map' | 'panels'): Promise<Program> {
    return (await import(address(`view/${name}.js`))) as Program;
}
