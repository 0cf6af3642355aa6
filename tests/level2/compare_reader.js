// Reads a Level II file with the npm package nexrad-level-2-data and compares it with what
// list_radials printed for the same volume.
//
// usage: node compare_reader.js PACKAGE_DIRECTORY FILE LINES
// Prints each kind of difference with its count and first place. The exit status is 1 if there is a difference.
//
// The package unpacks only the first bzip2 block of a record, and never returns from a record with several blocks.
// So this script unpacks the records, with the bzip2 library that the package uses.
// It does not compare what the package lacks or reads differently: CFP, block RELV, and in message 5 negative azimuth
// rates and the last three bits of an angle.
'use strict';

const fs = require('fs');

const [packageDirectory, file, linesFile] = process.argv.slice(2);
const { Level2Radar } = require(packageDirectory);
const bzip2 = require(`${packageDirectory}/../seek-bzip`);

const names = { REF: 'reflect', VEL: 'velocity', SW: 'spectrum', ZDR: 'zdr', PHI: 'phi', RHO: 'rho' };

const crcTable = Uint32Array.from({ length: 256 }, (_, n) => {
  let c = n;
  for (let bit = 0; bit < 8; bit += 1) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
  return c >>> 0;
});

function crc32OfCodes(values, scale, offset) {
  let crc = 0xffffffff;
  for (const value of values) {
    const code = value === null ? 0 : Math.round(scale === 0 ? value : value * scale + offset);
    crc = crcTable[(crc ^ (code >> 8)) & 0xff] ^ (crc >>> 8);
    crc = crcTable[(crc ^ code) & 0xff] ^ (crc >>> 8);
  }
  return (crc ^ 0xffffffff) >>> 0;
}

// Returns the volume header and the unpacked messages, a form of file that the package reads too.
function withoutLdm(bytes) {
  const headerBytes = 24;
  const parts = [bytes.subarray(0, headerBytes)];
  for (let at = headerBytes; at < bytes.length;) {
    const length = Math.abs(bytes.readInt32BE(at));
    parts.push(bzip2.decode(bytes.subarray(at + 4, at + 4 + length)));
    at += 4 + length;
  }
  return Buffer.concat(parts);
}

const differences = new Map();
let compared = 0;

function same(what, where, ours, theirs, tolerance = 0) {
  compared += 1;
  if (ours === theirs || Math.abs(ours - theirs) <= tolerance) return;
  const known = differences.get(what) || { count: 0, first: `${where}: ${ours} here, ${theirs} there` };
  known.count += 1;
  differences.set(what, known);
}

function compareHead(head, radar) {
  if (!head.filename) return; // a volume without a header: the writer makes one for it
  same('header date', 'header', head.date, radar.header.modified_julian_date);
  same('header time', 'header', head.ms, radar.header.milliseconds);
  // Headers of the first years have zeros instead of the ICAO.
  same('header ICAO', 'header', head.icao, radar.header.ICAO.replace(/\0+$/, ''));
  same('header version', 'header', head.filename.slice(6, 8), radar.header.version);
}

// Returns the angle as the package decodes it: 0 to 360 degrees, in steps of 8 codes.
function packageAngle(deg) {
  return (Math.floor((((deg + 360) % 360) * 32768) / 180 / 8 + 1e-6) * 8 * 180) / 32768;
}

function comparePattern(pattern, theirs) {
  same('pattern', 'message 5', pattern.number, theirs.pattern_number);
  same('pattern version', 'message 5', pattern.version, theirs.version);
  same('cuts', 'message 5', pattern.cuts.length, theirs.num_elevations);
  pattern.cuts.forEach((cut, index) => {
    const where = `cut ${index + 1}`;
    const their = theirs.elevations[index + 1];
    same('cut elevation', where, packageAngle(cut.elevation_deg), their.elevation_angle, 1e-6);
    same('cut channel', where, cut.channel, their.channel_config);
    same('cut waveform', where, cut.waveform, their.waveform_type);
    same('cut PRF', where, cut.prf, their.surv_prf_number);
    same('cut pulses', where, cut.pulses, their.surv_prf_pulse);
    if (cut.azimuth_rate_code >= 0) {
      const steps = Math.floor(cut.azimuth_rate_code / 8) * 8;
      same('cut azimuth rate', where, (steps * 22.5) / 16384, their.azimuth_rate, 1e-6);
    }
    ['ref', 'vel', 'sw', 'diff_ref', 'diff_ph', 'cor_coeff'].forEach((name, at) => {
      const threshold = (their[`${name}_threshold`] << 16) >> 16;
      same(`cut ${name} threshold`, where, cut.thresholds[at], threshold);
    });
    same('cut SAILS', where, cut.sails, their.supplemental_data.sails_cut);
    same('cut MRLE', where, cut.mrle, their.supplemental_data.mrle_cut);
    same('cut base tilt', where, cut.base_tilt, their.supplemental_data.base_tilt_cut);
  });
}

function compareMoment(name, where, ours, theirs) {
  const at = (what) => `${name} ${what}`;
  if (theirs === undefined) {
    same(at('is missing'), where, true, false);
    return;
  }
  same(at('gates'), where, ours.gates, theirs.gate_count);
  same(at('first gate'), where, ours.first_m / 1000, theirs.first_gate, 1e-9);
  same(at('gate spacing'), where, ours.spacing_m / 1000, theirs.gate_size, 1e-9);
  same(at('bits'), where, ours.bits, theirs.data_size);
  same(at('scale'), where, Math.fround(ours.scale), Math.fround(theirs.scale));
  same(at('offset'), where, Math.fround(ours.offset), Math.fround(theirs.offset));
  same(at('number of values'), where, ours.valid, theirs.moment_data.filter((v) => v !== null).length);
  same(at('values'), where, ours.crc32, crc32OfCodes(theirs.moment_data, theirs.scale, theirs.offset));
}

function compareRadial(ours, message, head) {
  const theirs = message.record;
  const where = `elevation ${ours.elevation_number}, azimuth number ${ours.azimuth_number}`;
  same('station', where, head.station, theirs.id);
  same('azimuth number', where, ours.azimuth_number, theirs.radial_number);
  same('azimuth', where, Math.fround(ours.azimuth_deg), Math.fround(theirs.azimuth));
  same('elevation', where, Math.fround(ours.elevation_deg), Math.fround(theirs.elevation_angle));
  same('status', where, ours.status, theirs.rs);
  same('date', where, ours.date, theirs.julian_date);
  same('time', where, ours.ms, theirs.mseconds);
  same('compression', where, 0, theirs.compress_idx);
  if (theirs.radial) {
    same('Nyquist velocity', where, ours.nyquist_mps, theirs.radial.nyquist_velocity / 100, 1e-5);
    same('unambiguous range', where, ours.unambiguous_range_m, theirs.radial.unambiguous_range * 1000, 1e-3);
  }
  const volume = theirs.volume || {};
  same('latitude', where, Math.fround(head.latitude_deg), Math.fround(volume.latitude));
  same('longitude', where, Math.fround(head.longitude_deg), Math.fround(volume.longitude));
  same('site height', where, head.site_height_m, volume.elevation);
  same('tower height', where, head.tower_height_m, volume.feedhorn_height);
  same('pattern of RVOL', where, head.block_vcp, volume.volume_coverage_pattern);
  for (const [name, key] of Object.entries(names)) {
    if (ours.moments[name]) compareMoment(name, where, ours.moments[name], theirs[key]);
    else same(`${name} is extra`, where, true, theirs[key] === undefined);
  }
}

// Compares a message 1. The package gives values without codes, and no spectrum width.
function compareRadial1(ours, message) {
  const theirs = message.record;
  const where = `elevation ${ours.elevation_number}, azimuth number ${ours.azimuth_number}`;
  const angleStep = 180 / 4096;
  same('azimuth number', where, ours.azimuth_number, theirs.azimuth_number);
  same('azimuth', where, ours.azimuth_deg, theirs.azimuth / 0.043945 * angleStep, 1e-4);
  const elevation = theirs.elevation_angle / 0.043945 * angleStep;
  same('elevation', where, ours.elevation_deg, elevation > 180 ? elevation - 360 : elevation, 1e-4);
  same('status', where, ours.status, theirs.radial_status);
  same('date', where, ours.date, theirs.julian_date);
  same('time', where, ours.ms, theirs.mseconds);
  same('Nyquist velocity', where, ours.nyquist_mps, theirs.nyquist_velocity, 1e-5);
  same('unambiguous range', where, ours.unambiguous_range_m, theirs.unambiguous_range * 1000, 1e-3);
  const { REF: ref, VEL: vel } = ours.moments;
  if (ref) {
    same('REF gates', where, ref.gates, theirs.number_of_surveillance_bins);
    same('REF first gate', where, ref.first_m / 1000, theirs.surveillance_range, 1e-9);
    same('REF gate spacing', where, ref.spacing_m / 1000, theirs.surveillance_range_sample_interval, 1e-9);
    same('REF values', where, ref.crc32, crc32OfCodes(theirs.reflect, 2, 66));
  }
  if (vel) {
    same('VEL gates', where, vel.gates, theirs.number_of_doppler_bins);
    same('VEL first gate', where, vel.first_m / 1000, theirs.doppler_range, 1e-9);
    same('VEL gate spacing', where, vel.spacing_m / 1000, theirs.doppler_range_sample_interval, 1e-9);
    // The package takes code 127 for velocity 0; the ICD takes 129.
    same('VEL values', where, vel.crc32,
      crc32OfCodes(theirs.velocity, 1 / theirs.doppler_velocity_resolution, 127));
  }
}

const lines = fs.readFileSync(linesFile, 'utf8').trim().split('\n').map((line) => JSON.parse(line));
const head = lines.shift();
const warnings = [];
const logger = { log: () => {}, warn: (m) => warnings.push(m), error: (m) => warnings.push(m) };
const radar = new Level2Radar(withoutLdm(fs.readFileSync(file)), { logger });

compareHead(head, radar);
if (head.pattern) comparePattern(head.pattern, radar.vcp.record || { elevations: [] });
same('truncated', 'file', false, radar.isTruncated);
for (const warning of warnings) same(`warning "${warning}"`, 'file', false, true);

// The package groups radials by elevation number, in file order.
const next = new Map();
for (const ours of lines) {
  const index = next.get(ours.elevation_number) || 0;
  next.set(ours.elevation_number, index + 1);
  const message = (radar.data[ours.elevation_number] || [])[index];
  if (message && ours.message_type === 1) compareRadial1(ours, message);
  else if (message) compareRadial(ours, message, head);
  else same('radial is missing', `elevation ${ours.elevation_number}`, true, false);
}
const found = radar.data.reduce((count, messages) => count + messages.length, 0);
same('radials', 'file', lines.length, found);

for (const [what, { count, first }] of differences) console.log(`  ${what}: ${count} times, first ${first}`);
console.log(`  ${lines.length} radials, ${compared} comparisons, ${differences.size} kinds of difference`);
process.exit(differences.size === 0 ? 0 : 1);
