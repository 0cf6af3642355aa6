#include "synth/read_instrument.h"

#include <cmath>

#include "synth/truth.h"

namespace stormcellar::synth {
namespace {

// If jitters were larger, a radial could overtake the previous radial.
constexpr TomlRange jitters_deg{0, 0.25};

bool read_switch(TomlTable& table, std::string_view key) {
    const std::string text = table.text(key).value_or("off");
    if (text != "on" && text != "off") table.complain(key, "must be \"on\" or \"off\"");
    return text == "on";
}

std::vector<int> read_cuts(TomlTable& table, std::string_view key, int cuts) {
    std::vector<int> read;
    for (const double number : table.numbers(key).value_or(std::vector<double>{})) {
        if (number >= 1 && number <= cuts && number == std::floor(number)) {
            read.push_back(static_cast<int>(number));
        } else {
            table.complain(key, fmt::format("{} is not a cut, must be 1 to {}", number, cuts));
        }
    }
    return read;
}

MissingSector read_sector(TomlTable& table, int cuts) {
    MissingSector sector;
    sector.cut = table.whole_number("cut", {1, static_cast<double>(cuts)});
    for (const std::string_view key : {"from_azimuth_deg", "to_azimuth_deg"}) {
        if (!table.has(key)) table.complain(key, "is missing");
    }
    sector.from_deg = table.number("from_azimuth_deg", directions_deg).value_or(0);
    sector.to_deg = table.number("to_azimuth_deg", directions_deg).value_or(0);
    return sector;
}

Clutter read_clutter(TomlTable& table) {
    Clutter clutter;
    clutter.peak_dbz = table.number("peak_dbz", {edge_dbz + 1, 90}).value_or(clutter.peak_dbz);
    clutter.range_m = table.number("range_km", {1, 200}).value_or(clutter.range_m / 1000) * 1000;
    clutter.texture_db = table.number("texture_db", {0, 20}).value_or(clutter.texture_db);
    return clutter;
}

}  // namespace

Instrument read_instrument(TomlTable table, int cuts) {
    Instrument instrument;
    instrument.seed =
        static_cast<std::uint32_t>(table.whole_number("seed", {0, 2147483647}).value_or(0));
    instrument.beam_width_deg = table.number("beam_width_deg", {0, 5}).value_or(0);
    instrument.pulse_length_m = table.number("pulse_length_m", {0, 3000}).value_or(0);
    instrument.noise_db = table.number("noise_db", {0, 6}).value_or(0);
    instrument.velocity_noise_mps = table.number("velocity_noise_mps", {0, 10}).value_or(0);
    instrument.velocity_folding = read_switch(table, "velocity_folding");
    instrument.range_folding = read_switch(table, "range_folding");
    instrument.azimuth_jitter_deg = table.number("azimuth_jitter_deg", jitters_deg).value_or(0);
    instrument.elevation_jitter_deg = table.number("elevation_jitter_deg", jitters_deg).value_or(0);
    instrument.missing_fraction = table.number("missing_fraction", {0, 1}).value_or(0);
    instrument.missing_gate_fraction = table.number("missing_gate_fraction", {0, 1}).value_or(0);
    instrument.speckle_fraction = table.number("speckle_fraction", {0, 1}).value_or(0);
    instrument.missing_cuts = read_cuts(table, "missing_cuts", cuts);
    for (TomlTable& sector : table.tables("missing_radials")) {
        instrument.missing_radials.push_back(read_sector(sector, cuts));
    }
    if (auto clutter = table.table("clutter")) instrument.clutter = read_clutter(*clutter);
    return instrument;
}

}  // namespace stormcellar::synth
