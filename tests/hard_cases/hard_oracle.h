// tests/hard_cases/hard_oracle.h -- decodes mutants and compares them with the undamaged volume.
//
// For every mutant, the oracle checks three things. The decoder returns the radials as their fates
// say, in the order in which the radar sent them, and no other radials. Sweeps begin only where a
// radial says so. For lost radials, the report has a problem that the undamaged volume does not
// have. The decoder may refuse the whole file only if it need not keep any radial.
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
    std::uint64_t compared = 0;  // returned radials that are equal to the bit
    std::uint64_t fallen = 0;    // lost radials in the damage, or under the same checksum
    std::uint64_t beside = 0;    // lost radials directly after the damage
    std::uint64_t changed = 0;   // returned radials that were damaged and are changed
};

class Oracle {
  public:
    // Decodes the undamaged file. Throws if this fails.
    explicit Oracle(std::span<const std::byte> file);

    [[nodiscard]] std::size_t radials() const { return radials_.size(); }
    // Decodes a mutant and returns a text about what is wrong with the result, or an empty text.
    [[nodiscard]] std::string check(const Mutant& mutant);
    [[nodiscard]] const std::map<std::string, KindFigures>& figures() const { return figures_; }
    [[nodiscard]] std::chrono::duration<double> slowest() const { return slowest_; }

  private:
    struct Match {
        std::string wrong;  // empty: all radials were returned as they should be
        bool lost = false;  // an expected radial was not returned
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
    std::set<std::string> own_problems_;  // problems of the undamaged volume
    std::map<std::string, KindFigures> figures_;
    std::chrono::duration<double> slowest_{0};
};

void add(std::map<std::string, KindFigures>& sum, const std::map<std::string, KindFigures>& more);
// Returns a table with a heading, a line for each kind, and a line with the sums.
[[nodiscard]] std::string table_of(const std::map<std::string, KindFigures>& figures);

}  // namespace stormcellar::level2
