// bench_dealias: dealiases velocities with each rung, and prints time and result.
//
// usage: bench_dealias [--data DIR] [--runs N] [--case] [--json] [FILE ...]
//   (bench/request.h; every real volume, unless files are named)
// Prints a row for each file and rung:
//   file         its name
//   rung         region or anchored
//   gates        gates with a velocity
//   folded       gates with a fold number other than 0
//   ambiguous    gates that are marked
//   jumps        pairs of adjacent gates that differ by more than the Nyquist velocity afterward
//   seconds      CPU time of one thread, the least of the runs
// FILE is a Level II file. With --case it is a file that bench/compare_dealiasing.py wrote, which
// holds sweeps with their true fold numbers: a number of sweeps; for each sweep the numbers of
// radials and gates, the first gate and the spacing in meters (all 32-bit); azimuth, elevation and
// Nyquist velocity of each radial and the velocity of each gate (32-bit floats); and the fold
// number of each gate (8 bits), -128 where it is unknown. Then the row has also:
//   wrong_pct         gates with another fold number than the true one
//   marked_wrong_pct  share of the wrong gates that are marked ambiguous
//   marked_right_pct  share of the right gates that are marked ambiguous
#include <cmath>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bench/request.h"
#include "bench/table.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/retrieve/dealias.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using retrieve::Dealiased;
using retrieve::Dealiasing;

constexpr std::int8_t unknown_fold = -128;

struct Case {
    level2::Volume volume;
    std::vector<std::vector<std::int8_t>> truth;  // of each sweep; empty for Level II files
};

class CaseReader {
  public:
    explicit CaseReader(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}

    Case read() {
        Case made;
        const auto sweeps = take<std::int32_t>(1).front();
        for (std::int32_t i = 0; i < sweeps; ++i)
            read_sweep(made);
        return made;
    }

  private:
    template <class Number>
    std::vector<Number> take(std::size_t count) {
        std::vector<Number> numbers(count);
        if (bytes_.size() - at_ < count * sizeof(Number)) throw std::runtime_error("cut short");
        std::memcpy(numbers.data(), bytes_.data() + at_, count * sizeof(Number));
        at_ += count * sizeof(Number);
        return numbers;
    }
    void read_sweep(Case& made) {
        constexpr float scale = 100, offset = 20'000;
        const auto shape = take<std::int32_t>(4);
        const auto radials = static_cast<std::size_t>(shape[0]);
        const auto gates = static_cast<std::size_t>(shape[1]);
        level2::Sweep& sweep = made.volume.sweeps.emplace_back();
        level2::SweepMoment& moment = sweep.moments.emplace_back();
        moment.moment = level2::Moment::vel;
        moment.gate_stride = shape[1];
        moment.first_gate_m = shape[2];
        moment.gate_spacing_m = shape[3];
        moment.word_size_bits = 16;
        moment.scale = scale;
        moment.offset = offset;
        moment.gate_counts.assign(radials, static_cast<std::uint16_t>(gates));
        const auto azimuths = take<float>(radials), elevations = take<float>(radials);
        const auto nyquists = take<float>(radials);
        for (std::size_t i = 0; i < radials; ++i) {
            level2::Radial& radial = sweep.radials.emplace_back();
            radial.azimuth_deg = azimuths[i];
            radial.elevation_deg = elevations[i];
            radial.nyquist_mps = nyquists[i];
        }
        for (const float velocity : take<float>(radials * gates)) {
            const float code = std::isnan(velocity) ? 0 : std::round(velocity * scale + offset);
            moment.codes16.push_back(static_cast<std::uint16_t>(code));
        }
        made.truth.push_back(take<std::int8_t>(radials * gates));
    }

    std::vector<std::byte> bytes_;
    std::size_t at_ = 0;
};

Case load(const fs::path& file, bool is_case) {
    if (is_case) {
        auto bytes = read_file(file);
        if (!bytes) throw std::runtime_error(bytes.error().message);
        return CaseReader(std::move(*bytes)).read();
    }
    auto decoded = level2::decode_file(file);
    if (!decoded) throw std::runtime_error(decoded.error().message);
    return {std::move(decoded->volume), {}};
}

// Counts the pairs of adjacent gates in a sweep that differ by more than the Nyquist velocity.
std::int64_t jumps_in(const level2::Sweep& sweep, const retrieve::SweepFolds& folds) {
    const level2::SweepMoment& moment = sweep.moments[folds.moment];
    const std::size_t radials = sweep.radials.size();
    const auto velocity = [&](std::size_t radial, std::int32_t gate) {
        if (moment.status(radial, gate) != level2::GateStatus::valid)
            return std::numeric_limits<float>::quiet_NaN();
        const std::size_t at =
            radial * static_cast<std::size_t>(moment.gate_stride) + static_cast<std::size_t>(gate);
        return moment.value_of(moment.code(radial, gate)) +
               2 * sweep.radials[radial].nyquist_mps * static_cast<float>(folds.folds[at]);
    };
    std::int64_t jumps = 0;
    for (std::size_t radial = 0; radial < radials; ++radial) {
        const float nyquist_mps = sweep.radials[radial].nyquist_mps;
        if (!(nyquist_mps > 0)) continue;
        for (std::int32_t gate = 0; gate < moment.gate_stride; ++gate) {
            const float here = velocity(radial, gate);
            jumps += std::abs(here - velocity(radial, gate + 1)) > nyquist_mps ? 1 : 0;
            jumps += std::abs(here - velocity((radial + 1) % radials, gate)) > nyquist_mps ? 1 : 0;
        }
    }
    return jumps;
}

struct Score {
    std::int64_t right = 0, wrong = 0, marked_right = 0, marked_wrong = 0;
};
Score score(const Case& of, const Dealiased& found) {
    Score score;
    for (const retrieve::SweepFolds& folds : found.sweeps) {
        const std::vector<std::int8_t>& truth = of.truth[folds.sweep];
        for (std::size_t gate = 0; gate < truth.size(); ++gate) {
            if (truth[gate] == unknown_fold) continue;
            const bool is_right = truth[gate] == folds.folds[gate];
            ++(is_right ? score.right : score.wrong);
            if (folds.ambiguous[gate] != 0) ++(is_right ? score.marked_right : score.marked_wrong);
        }
    }
    return score;
}

double percent(std::int64_t part, std::int64_t whole) {
    return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

void measure(const fs::path& file, const Request& request, Table& table) {
    const bool is_case = request.has("--case");
    const Case of = load(file, is_case);
    for (const Dealiasing rung : {Dealiasing::region, Dealiasing::anchored}) {
        Dealiased found;
        double least_s = std::numeric_limits<double>::infinity();
        for (int i = 0; i < request.runs; ++i) {
            const std::clock_t start = std::clock();
            found = retrieve::dealias(of.volume, rung);
            least_s = std::min(least_s, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
        }
        std::int64_t jumps = 0;
        for (const retrieve::SweepFolds& folds : found.sweeps)
            jumps += jumps_in(of.volume.sweeps[folds.sweep], folds);
        const auto count = [](std::int64_t number) { return Cell(static_cast<double>(number), 0); };
        Row row = {{"file", file.filename().string()},
                   {"rung", retrieve::dealiasing_name(rung)},
                   {"gates", count(found.gates)},
                   {"folded", count(found.folded_gates)},
                   {"ambiguous", count(found.ambiguous_gates)},
                   {"jumps", count(jumps)},
                   {"seconds", Cell(least_s, 3)}};
        if (is_case) {
            const Score gates = score(of, found);
            row.emplace_back("wrong_pct", Cell(percent(gates.wrong, gates.wrong + gates.right), 2));
            row.emplace_back("marked_wrong_pct", Cell(percent(gates.marked_wrong, gates.wrong), 0));
            row.emplace_back("marked_right_pct", Cell(percent(gates.marked_right, gates.right), 2));
        }
        table.add(std::move(row));
    }
}

}  // namespace
}  // namespace stormcellar::bench

int main(int argc, char** argv) {
    using namespace stormcellar::bench;
    const Program program{"bench_dealias",
                          "[FILE ...]",
                          "dealiases velocities with each rung, and prints time and result",
                          {"--case"}};
    return run_over_files(program, {argv, static_cast<std::size_t>(argc)}, measure);
}
