// bench_dealias: dealiases real velocities with each method (rung), and prints its time and result.
//
// usage: bench_dealias [--data DIR] [--runs N] [--case] [--json] [FILE ...]
//   (bench/request.h; every real volume, unless files are named)
// Prints a row for each file and each method:
//   file         name of the file
//   rung         name of the method: off, region or anchored
//   gates        number of gates with a velocity
//   folded       number of gates with a fold number other than 0
//   ambiguous    number of gates that are marked ambiguous
//   jumps        pairs of adjacent gates that still differ by more than the Nyquist velocity
//   seconds      CPU time of one thread, the least of the runs
// FILE is a Level II file. With --case it is a file that bench/compare_dealiasing.py wrote, which
// holds sweeps with their true fold numbers:
//   - the number of sweeps (32 bits); then for each sweep:
//   - the numbers of radials and gates, the first gate and the spacing in meters (32 bits each);
//   - azimuth, elevation and Nyquist velocity of each radial, and velocity of each gate (floats);
//   - the fold number of each gate (8 bits), -128 where it is unknown.
// With --case, a row also has:
//   wrong_pct         share of the gates whose fold number is not the true one
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
#include "retrieve/judge/refold.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/retrieve/dealias.h"

namespace stormcellar::bench {
namespace {

namespace fs = std::filesystem;
using retrieve::Dealiased;
using retrieve::Dealiasing;
using retrieve::KnownVolume;

constexpr std::int8_t unknown_fold = -128;

class CaseReader {
  public:
    explicit CaseReader(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}

    KnownVolume read() {
        KnownVolume made;
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
    void read_sweep(KnownVolume& made) {
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
        retrieve::SweepFolds& folds = made.folds.emplace_back();
        folds.sweep = made.volume.sweeps.size() - 1;
        folds.folds = take<std::int8_t>(radials * gates);
        for (const std::int8_t fold : folds.folds)
            folds.ambiguous.push_back(fold == unknown_fold ? 1 : 0);
    }

    std::vector<std::byte> bytes_;
    std::size_t at_ = 0;
};

KnownVolume load(const fs::path& file, bool is_case) {
    if (is_case) {
        auto bytes = read_file(file);
        if (!bytes) throw std::runtime_error(bytes.error().message);
        return CaseReader(std::move(*bytes)).read();
    }
    auto decoded = level2::decode_file(file);
    if (!decoded) throw std::runtime_error(decoded.error().message);
    return {std::move(decoded->volume), {}};
}

double percent(std::int64_t part, std::int64_t whole) {
    return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

void measure(const fs::path& file, const Request& request, Table& table) {
    const bool is_case = request.has("--case");
    const KnownVolume of = load(file, is_case);
    for (const Dealiasing rung : {Dealiasing::off, Dealiasing::region, Dealiasing::anchored}) {
        Dealiased found;
        double least_s = std::numeric_limits<double>::infinity();
        for (int i = 0; i < request.runs; ++i) {
            const std::clock_t start = std::clock();
            found = retrieve::dealias(of.volume, rung);
            least_s = std::min(least_s, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
        }
        const std::int64_t jumps = retrieve::count_jumps(of.volume, found);
        const auto count = [](std::int64_t number) { return Cell(static_cast<double>(number), 0); };
        Row row = {{"file", file.filename().string()},
                   {"rung", retrieve::dealiasing_name(rung)},
                   {"gates", count(found.gates)},
                   {"folded", count(found.folded_gates)},
                   {"ambiguous", count(found.ambiguous_gates)},
                   {"jumps", count(jumps)},
                   {"seconds", Cell(least_s, 3)}};
        if (is_case) {
            const retrieve::FoldScore score = retrieve::score_folds(of, found);
            const std::int64_t marked_wrong = score.wrong - score.wrong_unmarked;
            const std::int64_t marked = score.known - score.known_unmarked;
            row.emplace_back("wrong_pct", Cell(100 * score.wrong_share(), 2));
            row.emplace_back("marked_wrong_pct", Cell(percent(marked_wrong, score.wrong), 0));
            row.emplace_back("marked_right_pct",
                             Cell(percent(marked - marked_wrong, score.known - score.wrong), 2));
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
