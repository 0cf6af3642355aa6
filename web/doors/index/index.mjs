// Fills the lists of the index page with stations and mosaics of the API, and its examples with a station of this
// server.

const minute = 60;
const hour = 60 * minute;
const day = 24 * hour;

// Data farther in the future come from a wrong clock, and do not make a station live. base/utc_time.h has the same
// limit.
const toleratedFuture = 10 * minute;

async function asked(name) {
    const answer = await fetch(new URL(`api/v1/${name}`, import.meta.url));
    if (!answer.ok) throw new Error(`${name}: ${answer.status}`);
    return answer.json();
}

// For older data, a date says more than an age.
const isOld = (seconds) => seconds >= 2 * day;

// Returns "42 s", "3 min", "5 h 20 min", "12 days", "3 years".
function ageText(seconds) {
    if (seconds < -minute) return 'in the future';
    const whole = Math.max(0, Math.floor(seconds));
    if (whole < 90) return `${whole} s`;
    if (whole < 90 * minute) return `${Math.floor(whole / minute)} min`;
    if (whole < 2 * day) return `${Math.floor(whole / hour)} h ${Math.floor((whole % hour) / minute)} min`;
    if (whole < 2 * 365 * day) return `${Math.floor(whole / day)} days`;
    return `${Math.floor(whole / (365.2425 * day))} years`;
}

// Returns "2026-05-01 12:00:31" for "2026-05-01T12:00:31.250Z".
const readable = (time) => time.slice(0, 19).replace('T', ' ');
// Returns the arguments of Python's datetime: "2026, 5, 1, 12, 0".
const datetimeArguments = (time) => time.split(/\D/).slice(0, 5).map(Number).join(', ');

function element(name, text, properties = {}) {
    return Object.assign(document.createElement(name), { textContent: text }, properties);
}

// Puts the age and the time of the newest data into a cell, or the text `none` if `newest` is missing. Old data have a
// time only.
function showAge(cell, newest, none = 'none') {
    if (newest) {
        const time = element('time', readable(newest.time), { dateTime: newest.time });
        cell.append(...(isOld(newest.age_s) ? [] : [element('b', ageText(newest.age_s)), ' ']), time);
    } else {
        cell.append(element('span', none, { className: 'none' }));
    }
}

// Returns a row made from a template, with name, newest grid, moments and links.
function rowOf(template, { name, newestGrid, moments }) {
    const row = document.getElementById(template).content.cloneNode(true).querySelector('tr');
    row.querySelector('th b').textContent = name;
    showAge(row.querySelector('.grid'), newestGrid);
    row.querySelector('.moments').textContent = moments.join(' ');
    for (const link of row.querySelectorAll('a'))
        link.setAttribute(
            'href',
            link.getAttribute('href').replace('NAME', () => encodeURIComponent(name)),
        );
    if (moments.length === 0) row.querySelector('.grids').remove();
    return row;
}

const isBelieved = (newest) => newest.age_s >= -toleratedFuture;
const isSilent = (station) => typeof station.silent_s === 'number';

function stateOf(station) {
    if (isSilent(station)) return 'silent';
    const isLive = (newest) => newest && isBelieved(newest) && newest.age_s < hour;
    return isLive(station.newest_volume) || isLive(station.newest_grid) ? 'live' : 'archive';
}

function stationRow(station) {
    const row = rowOf('station', { name: station.station, newestGrid: station.newest_grid, moments: station.moments });
    const state = stateOf(station);
    row.className = state;
    row.querySelector('th span').textContent = [station.name, station.state].filter(Boolean).join(', ');
    row.querySelector('.state i').textContent = state;
    if (isSilent(station)) row.querySelector('.state span').textContent = ` for ${ageText(station.silent_s)}`;
    // The server does not know the newest volume if it cannot read its database, or if all volumes come from the
    // future.
    const isUnknown =
        station.newest_volume === undefined || (station.newest_grid !== null && !isBelieved(station.newest_grid));
    showAge(row.querySelector('.volume'), station.newest_volume, isUnknown ? 'not known' : 'none');
    return row;
}

// Returns time and age of the newest grid of a domain.
const newestOf = (domain) =>
    domain.moments
        .map((one) => ({ time: one.newest, age_s: one.age_s }))
        .reduce((newest, one) => (one.age_s < newest.age_s ? one : newest));

function domainRow(domain) {
    const moments = domain.moments.map((one) => one.moment);
    return rowOf('domain', { name: domain.domain, newestGrid: newestOf(domain), moments });
}

function summary(stations) {
    if (stations.length === 0) return 'Nothing has come yet.';
    const parts = [`${stations.length} station${stations.length === 1 ? '' : 's'}`];
    const silent = stations.filter(isSilent).length;
    if (silent > 0) parts.push(`, ${silent} of them silent`);
    const ages = stations.flatMap((one) => [one.newest_volume, one.newest_grid]).filter(Boolean);
    const newest = ages.reduce((best, one) => (best === null || one.age_s < best.age_s ? one : best), null);
    if (newest?.age_s < -minute) parts.push('; the newest volume has a time in the future');
    else if (newest && isOld(newest.age_s)) parts.push(`; the newest volume is of ${newest.time.slice(0, 10)}`);
    else if (newest) parts.push(`; the newest volume began ${ageText(newest.age_s)} ago`);
    return `${parts.join('')}.`;
}

// Puts a station into the examples. Prefers stations that have volumes, and next stations that are not silent. If the
// station has no grids, examples of grids get the first mosaic.
function fillExamples(stations, domains) {
    const worth = (station) => (station.newest_volume ? 2 : 0) + (isSilent(station) ? 0 : 1);
    if (stations.length === 0) return;
    const best = stations.reduce((best, one) => (worth(one) > worth(best) ? one : best));
    const facts = { station: best.station, domain: best.station, moment: best.moments[0] };
    if (best.newest_volume) {
        facts.day = best.newest_volume.time.slice(0, 10).replaceAll('-', '/');
        facts.when = datetimeArguments(best.newest_volume.time);
    }
    if (best.moments.length === 0 && domains.length > 0) {
        facts.domain = domains[0].domain;
        facts.moment = domains[0].moments[0].moment;
    }
    for (const [name, value] of Object.entries(facts).filter(([, value]) => value))
        for (const place of document.querySelectorAll(`var.${name}`)) place.textContent = value;
}

// Shows a list. If it is empty, shows the section's text for this case, or hides a section that has no such text.
function showList(id, rows) {
    const section = document.getElementById(id);
    section.querySelector('tbody').replaceChildren(...rows);
    section.querySelector('table').hidden = rows.length === 0;
    section.querySelector('p')?.toggleAttribute('hidden', rows.length > 0);
    section.hidden = rows.length === 0 && !section.querySelector('p');
}

async function fillPage() {
    const [{ time, stations }, answer] = await Promise.all([asked('stations'), asked('domains')]);
    const names = new Set(stations.map((one) => one.station));
    const isMosaic = (one) => one.part_of === null && one.moments.length > 0 && !names.has(one.domain);
    const domains = answer.domains.filter(isMosaic);
    document.querySelector('.lead').textContent = summary(stations);
    document.querySelector('.asof span').textContent = `As of ${readable(time)} UTC.`;
    showList('stations', stations.map(stationRow));
    showList('domains', domains.map(domainRow));
    fillExamples(stations, domains);
}

document.querySelector('details')?.toggleAttribute('open', true);
fillPage().catch((error) => {
    document.querySelector('.lead').textContent = `The lists could not be read (${error.message}).`;
});
