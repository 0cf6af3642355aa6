// Writes color tables in TOML, as docs/rendering.md describes. The reader is in another file, because the page loads it
// only with the editor.

import { TableFile, hexOf } from './table_file';

const quoted = (text: string): string => `"${text.replace(/[^\x20-\x7e]/g, '?').replace(/["\\]/g, '\\$&')}"`;

export function writeToml(file: TableFile): string {
    const lines = ['# A color table for stormcellar frame --colors FILE, and for the viewer.'];
    lines.push(`name = ${quoted(file.name)}`);
    if (file.moment !== null) lines.push(`moment = ${quoted(file.moment)}`);
    else if (file.unit) lines.push(`unit = ${quoted(file.unit)}`);
    if (file.isStepped) lines.push('stepped = true');
    if (file.end !== null) lines.push(`end = ${file.end}`);
    if (file.rangeFolded) lines.push(`range_folded = "${hexOf(file.rangeFolded)}"`);
    for (const { value, color, until, perKm } of file.points) {
        lines.push('', '[[point]]', `value = ${value}`, `color = "${hexOf(color)}"`);
        if (until) lines.push(`until = "${hexOf(until)}"`);
        if (perKm !== null) lines.push(`opacity_per_km = ${perKm}`);
    }
    return `${lines.join('\n')}\n`;
}
