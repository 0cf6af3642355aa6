// stormcellar/base/station_rule.h -- decides which stations' data are accepted.
//
// A file may claim to be from any station, and each accepted station gets a database, a domain in
// the cache and a share of the memory and of the queue. So only stations that pass a rule get
// these. There are three rules:
//   known   the station table, and the stations added to it (set_added_stations())
//   any     the stations of `known`, and the first `most_further` other names that are admitted
//   listed  only the listed stations
// Files of all other stations are cataloged among the files of unknown stations, and not gridded.
// Every rule accepts only names of four characters, [A-Z][A-Z0-9]{3}.
//
// Threads   Any thread may call every function.
// Errors    None.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/mutex.h"

namespace stormcellar {

class StationRule {
  public:
    static constexpr std::size_t usual_most_further = 64;
    static constexpr std::size_t no_limit = static_cast<std::size_t>(-1);

    enum class Kind { known, any, listed };

    // Makes the rule `known`.
    StationRule() = default;
    [[nodiscard]] static StationRule any(std::size_t most_further = usual_most_further);
    [[nodiscard]] static StationRule listed(const std::vector<std::string>& stations);
    StationRule(const StationRule& other);
    StationRule& operator=(const StationRule& other);
    ~StationRule() = default;

    [[nodiscard]] Kind kind() const { return kind_; }
    // Returns true if data of this station are accepted without admitting a new name. Does not
    // change the rule.
    [[nodiscard]] bool knows(std::string_view station) const;
    // Returns true if data of this station are accepted. The rule `any` admits a new name for good,
    // as long as it has admitted fewer than `most_further`.
    [[nodiscard]] bool admits(std::string_view station);
    // Returns the further stations that `any` has admitted, sorted.
    [[nodiscard]] std::vector<std::string> further() const;
    [[nodiscard]] std::size_t most_further() const { return most_further_; }
    // Returns true if both rules have the same configuration. Admitted names do not count.
    bool operator==(const StationRule& other) const;

  private:
    Kind kind_ = Kind::known;
    std::size_t most_further_ = 0;
    std::set<std::string, std::less<>> listed_;
    mutable Mutex mutex_;
    std::set<std::string, std::less<>> further_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar
