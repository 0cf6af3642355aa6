// Reads the values that files of shapes share (render/overlay/shape_values.h).
//
// Errors: an Error with the value.

import { Place } from '../earth/projection';
import { Rgb } from './shapes';

// Returns the place. Longitudes up to 360 degrees are turned into longitudes from -180 to 180.
export function shapePlace(latitudeDeg: number, longitudeDeg: number): Place {
    const isOnEarth = Math.abs(latitudeDeg) <= 90 && Math.abs(longitudeDeg) <= 360;
    if (!isOnEarth) throw new Error(`${latitudeDeg}, ${longitudeDeg} is no place`);
    const turn = longitudeDeg > 180 ? -360 : longitudeDeg < -180 ? 360 : 0;
    return { latitudeDeg, longitudeDeg: longitudeDeg + turn };
}

const mostLabel = 80;
// Control characters and invisible characters.
const hidden = /[\p{Cc}\p{Cf}\p{Zl}\p{Zp}\p{Co}\p{Cn}\u034F\u115F\u1160\u3164\uFFA0\uFE00-\uFE0F]/gu;

// Returns the first 80 characters of a text, with \xNN for each byte of a character that would be invisible.
export function shapeLabel(text: string): string {
    const bytesOf = (letter: string) => [...new TextEncoder().encode(letter)];
    const escaped = (letter: string) => bytesOf(letter).map((byte) => `\\x${byte.toString(16).padStart(2, '0')}`);
    return Array.from(text.slice(0, 2 * mostLabel))
        .slice(0, mostLabel)
        .join('')
        .replace(hidden, (letter) => escaped(letter).join(''));
}

// Reads #rgb or #rrggbb.
export function shapeColor(text: string): Rgb {
    const short = /^#([\da-f])([\da-f])([\da-f])$/i.exec(text);
    const parts = short ? short.slice(1).map((one) => one + one) : /^#(..)(..)(..)$/.exec(text)?.slice(1);
    const levels = parts?.map((part) => (/^[\da-f]{2}$/i.test(part) ? parseInt(part, 16) : NaN));
    if (!levels?.every(Number.isFinite)) throw new Error(`'${text}' is no color such as #ff8800`);
    return levels as [number, number, number];
}

const isoTime = /^(\d{4})-(\d\d)-(\d\d)(?:[T ](\d\d):(\d\d)(?::(\d\d)(?:\.(\d+))?)?)?Z?$/;
const compactTime = /^(\d{4})(\d\d)(\d\d)_?(\d\d)(\d\d)(\d\d)?$/;

// Reads a time, and returns ms since 1970. The text is ISO 8601 with Z, with an offset such as -05:00 or without a zone
// (UTC), or has the digits YYYYMMDDhhmm.
export function shapeTime(text: string): number {
    const [, plain = text, sign = '', hours = '0', minutes = '0'] =
        /^(.*:.*)([+-])(\d\d):?(\d\d)$/.exec(text) ?? ([] as string[]);
    const found = isoTime.exec(plain) ?? compactTime.exec(plain);
    const [year = NaN, month = 1, day = 1, hour = 0, minute = 0, second = 0] = (found ?? [])
        .slice(1, 7)
        .map((part: string | undefined) => Number(part ?? 0));
    const ms = Math.floor(1000 * Number(`0.${found?.[7] ?? 0}`));
    const time = Date.UTC(year, month - 1, day, hour, minute, second, ms);
    // Date.UTC() takes 31 February for 2 March.
    const date = new Date(time);
    const isReal =
        date.getUTCMonth() === month - 1 && date.getUTCDate() === day && hour < 24 && minute < 60 && second < 60;
    if (!isReal) throw new Error(`'${text}' is no time`);
    const offsetMs = 60_000 * (60 * Number(hours) + Number(minutes));
    return sign === '-' ? time + offsetMs : time - offsetMs;
}
