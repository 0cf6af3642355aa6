#include "tests/hard_cases/hard_oracle.h"

#include <cstdlib>
#include <stdexcept>

#include <fmt/format.h>

namespace stormcellar::level2 {
namespace {

using Clock = std::chrono::steady_clock;

std::string key_of(const Problem& problem) {
    return fmt::format("{} {} {}", problem.code, problem.offset.value_or(0), problem.message);
}

bool begins_sweep(const Radial& radial) {
    const RadialStatus status = status_of(radial);
    return status == RadialStatus::start_of_elevation || status == RadialStatus::start_of_volume ||
           status == RadialStatus::start_of_last_elevation;
}

// Returns a text about a sweep that begins or goes on although the radials say otherwise, or an
// empty text if there is no such sweep.
std::string wrong_sweep(const Decoded& decoded) {
    const std::vector<Sweep>& sweeps = decoded.volume.sweeps;
    for (std::size_t i = 0; i < sweeps.size(); ++i) {
        for (std::size_t radial = 1; radial < sweeps[i].radials.size(); ++radial) {
            if (begins_sweep(sweeps[i].radials[radial]))
                return fmt::format("sweep {} goes on over a start of a sweep", i);
        }
        const bool said = i == 0 || begins_sweep(sweeps[i].radials.front()) ||
                          sweeps[i].elevation_number != sweeps[i - 1].elevation_number ||
                          sweeps[i].message_type != sweeps[i - 1].message_type ||
                          !decoded.report.further_headers.empty();
        if (!said) return fmt::format("sweep {} is made up", i);
    }
    return {};
}

}  // namespace

Oracle::Oracle(std::span<const std::byte> file) {
    const auto decoded = decode(file);
    if (!decoded) throw std::runtime_error("the undamaged file: " + decoded.error().message);
    radials_ = identities(decoded->volume);
    for (const Problem& problem : decoded->report.problems)
        own_problems_.insert(key_of(problem));
}

bool Oracle::names_something(const DecodeReport& report) const {
    for (const Problem& problem : report.problems) {
        // A missing end counts even if the undamaged volume has no end, because a cut between
        // records shows nothing else.
        if (problem.severity != Severity::note &&
            (problem.code == "no_end_of_volume" || !own_problems_.contains(key_of(problem)))) {
            return true;
        }
    }
    return false;
}

// Walks through the expected and the returned radials in the order of the volume. If a returned
// radial is not the next expected radial, but equals a later expected radial within the same
// damage, the radials between these two are lost. Otherwise the returned radial may be the damaged
// radial itself.
Oracle::Match Oracle::match(const Mutant& mutant, const std::vector<RadialIdentity>& found,
                            KindFigures& figures) const {
    Match match;
    const std::vector<ExpectedRadial>& expected = mutant.expected;
    std::size_t at = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const ExpectedRadial& due = expected[i];
        if (at < found.size() && is(due.radial, found[at])) {
            ++at;
            ++figures.compared;
            continue;
        }
        if (due.fate == Fate::kept) {
            match.wrong = fmt::format("radial {} of the undamaged volume is {}", *due.radial,
                                      at < found.size() ? "changed or missing" : "missing");
            return match;
        }
        if (due.fate == Fate::damaged && at < found.size()) {
            std::size_t next = i + 1;
            while (next < expected.size() && !is(expected[next].radial, found[at]) &&
                   expected[next].fate != Fate::kept)
                ++next;
            if (next == expected.size() || !is(expected[next].radial, found[at])) {
                ++at;
                ++figures.changed;
                continue;
            }
        }
        if (!due.radial) continue;
        match.lost = true;
        ++(due.fate == Fate::beside ? figures.beside : figures.fallen);
    }
    if (at < found.size() && !mutant.anything_after) {
        match.wrong = fmt::format("{} radials that no one sent", found.size() - at);
    }
    return match;
}

std::string Oracle::judge(const Mutant& mutant, const Result<Decoded>& decoded,
                          KindFigures& figures) const {
    if (!decoded) {
        ++figures.refused;
        for (const ExpectedRadial& due : mutant.expected) {
            if (due.fate == Fate::kept) return "refused: " + decoded.error().message;
        }
        const ErrorCode code = decoded.error().code;
        const bool said = code == ErrorCode::empty || code == ErrorCode::truncated ||
                          code == ErrorCode::corrupt || code == ErrorCode::not_level2;
        return said ? "" : "refused as something else: " + decoded.error().message;
    }
    Match match = this->match(mutant, identities(decoded->volume), figures);
    if (!match.wrong.empty()) return match.wrong;
    if (std::string wrong = wrong_sweep(*decoded); !wrong.empty()) return wrong;
    if (names_something(decoded->report)) return {};
    if (mutant.always_named) return "the damage is not named";
    const bool lost = match.lost || mutant.expected.size() < radials_.size();
    return lost ? "radials are lost and no problem says so" : "";
}

std::string Oracle::check(const Mutant& mutant) {
    KindFigures& figures = figures_[mutant.kind];
    ++figures.mutants;
    const auto begin = Clock::now();
    const auto decoded = decode(mutant.file);
    slowest_ = std::max<std::chrono::duration<double>>(slowest_, Clock::now() - begin);
    return judge(mutant, decoded, figures);
}

namespace {

void add(KindFigures& sum, const KindFigures& more) {
    sum.mutants += more.mutants;
    sum.refused += more.refused;
    sum.compared += more.compared;
    sum.fallen += more.fallen;
    sum.beside += more.beside;
    sum.changed += more.changed;
}

std::string line_of(const std::string& kind, const KindFigures& f) {
    return fmt::format("{:<36} {:>8} {:>8} {:>10} {:>8} {:>8} {:>8}\n", kind, f.mutants, f.refused,
                       f.compared, f.fallen, f.beside, f.changed);
}

}  // namespace

void add(std::map<std::string, KindFigures>& sum, const std::map<std::string, KindFigures>& more) {
    for (const auto& [kind, figures] : more)
        add(sum[kind], figures);
}

std::string table_of(const std::map<std::string, KindFigures>& figures) {
    std::string table =
        fmt::format("{:<36} {:>8} {:>8} {:>10} {:>8} {:>8} {:>8}\n", "kind", "mutants", "refused",
                    "compared", "fallen", "beside", "changed");
    KindFigures sum;
    for (const auto& [kind, f] : figures) {
        table += line_of(kind, f);
        add(sum, f);
    }
    return table + line_of("all", sum);
}

}  // namespace stormcellar::level2
