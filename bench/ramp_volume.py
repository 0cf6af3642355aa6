"""Writes synthetic ramps of differential phase as a Level II file, for bench/compare_kdp.py.

The file has one sweep of 360 radials, 45 for each of eight ramps, and no compression. The bytes
follow the ICDs 2620002 (message 31) and 2620010 (Archive II).
"""
import struct

import numpy as np

GATES, SPACING_KM, FIRST_KM, RADIALS = 400, 0.25, 2.125, 45
RANGES_KM = FIRST_KM + SPACING_KM * np.arange(GATES)


def core(middle_km, width_km):
    return np.exp(-0.5 * ((RANGES_KM - middle_km) / width_km) ** 2)


def between(begin_km, end_km):
    return ((RANGES_KM > begin_km) & (RANGES_KM < end_km)).astype(float)


# Name, KDP in degrees/km, standard deviation of the noise and first phase in degrees, hard parts.
RAMPS = [
    ('constant', np.full(GATES, 1.0), 2, 60, ''),
    ('weak', np.full(GATES, 0.1), 3, 60, ''),
    ('wraps', 4 * between(12, 92), 3, 300, ''),
    ('step', 3 * between(42, 52), 2, 60, ''),
    ('core', 5 * core(52, 1.5), 2, 60, ''),
    ('two cores', 0.2 + 3 * core(37, 3) + 2 * core(62, 5), 2, 60, ''),
    ('gaps', np.full(GATES, 1.5), 2, 60, 'gaps'),
    ('speckle', np.full(GATES, 1.0), 2, 60, 'speckle'),
]


def phases_of(ramp, random):
    """Returns phases in degrees, NaN without a value, and correlation coefficients."""
    _, kdp, noise_deg, first_deg, hard = ramp
    along = first_deg + 2 * SPACING_KM * (np.cumsum(kdp) - kdp / 2)
    phases = along + random.normal(0, noise_deg, (RADIALS, GATES))
    correlations = np.full(phases.shape, 0.99)
    if hard == 'speckle':
        bad = random.random(phases.shape) < 0.1
        phases[bad] = random.uniform(0, 360, bad.sum())
        correlations[bad] = np.where(random.random(bad.sum()) < 0.8, 0.6, 0.99)
    if hard == 'gaps':
        gates = np.arange(GATES)
        phases[:, (gates % 40 < 4) | ((gates >= 200) & (gates < 230))] = np.nan
    return phases % 360, correlations


def coded(values, scale, offset, word_bits):
    codes = np.where(np.isnan(values), 0, np.round(np.nan_to_num(values) * scale + offset))
    return codes.astype('>u2' if word_bits == 16 else 'u1').tobytes()


def moment_block(name, values, scale, offset, word_bits):
    return struct.pack('>c3sIHhhhhBBff', b'D', name, 0, GATES, round(1000 * FIRST_KM),
                       round(1000 * SPACING_KM), 0, 16, 0, word_bits, scale,
                       offset) + coded(values, scale, offset, word_bits)


def message_31(number, count, phases, correlations):
    """Returns one radial of the sweep."""
    echo = ~np.isnan(phases)
    blocks = [
        struct.pack('>c3sHBBffhHfffffH2s', b'R', b'VOL', 44, 1, 0, 35.333, -97.278, 370, 20, 0, 700,
                    700, 0, 60, 12, b''),
        struct.pack('>c3sHhf', b'R', b'ELV', 12, -12, 0),
        struct.pack('>c3sHhffh2sff', b'R', b'RAD', 28, 4660, -80, -80, 900, b'', -40, -40),
        moment_block(b'REF', np.where(echo, 42.0, np.nan), 2, 66, 8),
        moment_block(b'ZDR', np.where(echo, 1.0, np.nan), 32, 418, 16),
        moment_block(b'PHI', phases, 2.8361, 2, 16),
        moment_block(b'RHO', np.where(echo, correlations, np.nan), 300, -60.5, 8),
    ]
    head_bytes = 32 + 4 * 10
    pointers, at = [], head_bytes
    for block in blocks:
        pointers.append(at)
        at += len(block)
    pointers += [0] * (10 - len(pointers))
    status = 3 if number == 1 else 4 if number == count else 1
    ms, day = 43_200_000 + 40 * number, 19_000
    body = struct.pack('>4sIHHfBBHBBBBfBBH10I', b'KTLX', ms, day, number, float(number - 1) + 0.5,
                       0, 0, at, 2, status, 1, 0, 0.5, 0, 100, len(blocks), *pointers)
    body += b''.join(blocks)
    body += b'\0' * (len(body) % 2)
    head = struct.pack('>HBBHHIHH', (len(body) + 16) // 2, 0, 31, number, day, ms, 1, 1)
    return b'\0' * 12 + head + body


def write_ramps(path):
    """Writes the file, and returns the true KDP of all radials."""
    random = np.random.default_rng(1)
    rows = [phases_of(ramp, random) for ramp in RAMPS]
    phases = np.concatenate([row[0] for row in rows])
    correlations = np.concatenate([row[1] for row in rows])
    with open(path, 'wb') as file:
        file.write(struct.pack('>12sII4s', b'AR2V0006.001', 19_000, 43_200_000, b'KTLX'))
        for number in range(1, len(phases) + 1):
            file.write(message_31(number, len(phases), phases[number - 1],
                                  correlations[number - 1]))
    return np.repeat([ramp[1] for ramp in RAMPS], RADIALS, axis=0)
