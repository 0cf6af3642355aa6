// Judges how live the shown data are: their age, and whether the radar and the server are silent.

import { isAhead } from '../time/timeline';
import { newsS, span, texts } from './texts';

const freshS = 10 * 60; // two volumes of any usual scan
const liveS = 30 * 60; // no radar takes so long from one volume to the next

//   live     the newest data are at most 10 minutes old
//   late     they are older, but not so old that the page shows a date
//   silent   the radar or the server sends nothing
//   archive  old data, data of the future, or none
export type HealthLevel = 'live' | 'late' | 'silent' | 'archive';
export interface Health {
    level: HealthLevel;
    text: string;
}

// `ageS` is the age of the newest data, NaN without any. `silentS` is the time since a radar of the picture became
// silent; null if no radar of the picture is silent.
export function healthOf(ageS: number, silentS: number | null, isCutOff: boolean): Health {
    const words = texts.health;
    if (isCutOff) return { level: 'silent', text: words.noServer };
    if (silentS !== null && silentS < newsS) return { level: 'silent', text: words.silent(span(silentS)) };
    if (Number.isNaN(ageS) || isAhead(ageS) || ageS >= newsS) return { level: 'archive', text: texts.latest };
    const name = ageS < liveS ? texts.live : texts.latest;
    return { level: ageS < freshS ? 'live' : 'late', text: words.old(name, span(ageS)) };
}
