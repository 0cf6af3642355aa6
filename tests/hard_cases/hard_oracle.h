// tests/hard_cases/hard_oracle.h -- decodes mutants and compares them with the undamaged volume.
//
// For every mutant it checks: radials are returned as their fates say, in the order in which the
// radar sent them, and no others; sweeps begin only where a radial says so; whatever is lost is
// named by a problem that the undamaged volume does not have. Or the whole file is refused, which
// is allowed only if nothing in it had to be kept.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "stormcellar/level2/decode.h"
#include "tests/hard_cases/mutant.h"
#include "tests/level2/radial_identity.h"

namespace stormcellar::level2 {

struct KindFigures {
    std::uint64_t mutants = 0;
    std::uint64_t refused = 0;   // an error instead of a volume
    std::uint64_t compared = 0;  // radials found equal to the bit
    std::uint64_t fallen = 0;   // radials in the damage, or guarded with it, that were not returned
    std::uint64_t beside = 0;   // radials directly after the damage that were not returned
    std::uint64_t changed = 0;  // radials that show their own damage
};

class Oracle {
  public:
    // The undamaged file, which must decode.
    explicit Oracle(std::span<const std::byte> file);

    [[nodiscard]] std::size_t radials() const { return radials_.size(); }
    // Returns what is wrong; empty if everything is right.
    [[nodiscard]] std::string check(const Mutant& mutant);
    [[nodiscard]] const std::map<std::string, KindFigures>& figures() const { return figures_; }
    [[nodiscard]] std::chrono::duration<double> slowest() const { return slowest_; }

  private:
    struct Match {
        std::string wrong;  // empty: all radials were returned as they should be
        bool lost = false;  // an expected one was not returned
    };
    [[nodiscard]] bool is(std::optional<std::size_t> radial, RadialIdentity found) const {
        return radial && radials_[*radial] == found;
    }
    [[nodiscard]] std::string judge(const Mutant& mutant, const Result<Decoded>& decoded,
                                    KindFigures& figures) const;
    [[nodiscard]] Match match(const Mutant& mutant, const std::vector<RadialIdentity>& found,
                              KindFigures& figures) const;
    [[nodiscard]] bool names_something(const DecodeReport& report) const;

    std::vector<RadialIdentity> radials_;
    std::set<std::string> own_problems_;  // of the undamaged volume
    std::map<std::string, KindFigures> figures_;
    std::chrono::duration<double> slowest_{0};
};

void add(std::map<std::string, KindFigures>& sum, const std::map<std::string, KindFigures>& more);
// Returns one line for each kind, and the sum.
[[nodiscard]] std::string table_of(const std::map<std::string, KindFigures>& figures);

}  // namespace stormcellar::level2
