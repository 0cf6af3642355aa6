// stormcellar/base/station_rule.h -- of which stations data are taken in.
//
// A file may claim to be of any station, and each station that is believed gets a database, a
// domain in the cache and a share of memory and of the queue. So names are asked for here before
// they get anything. Three rules:
//   known   the station table and the stations that were added to it (add_stations())
//   any     the same, and the first `most_further` other names that are admitted
//   listed  the named stations alone
// Data of every other station are cataloged among those of no known station, and not gridded.
// A name is four characters, [A-Z][A-Z0-9]{3}; whatever is none is never believed.
// Thread contract: all may be called by any thread.
#pragma once

#include <cstddef>
#include <mutex>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace stormcellar {

class StationRule {
  public:
    static constexpr std::size_t usual_most_further = 64;
    static constexpr std::size_t no_limit = static_cast<std::size_t>(-1);

    enum class Kind { known, any, listed };

    // The rule `known`.
    StationRule() = default;
    [[nodiscard]] static StationRule any(std::size_t most_further = usual_most_further);
    [[nodiscard]] static StationRule listed(const std::vector<std::string>& stations);
    StationRule(const StationRule& other);
    StationRule& operator=(const StationRule& other);
    ~StationRule() = default;

    [[nodiscard]] Kind kind() const { return kind_; }
    // Whether data of this station are taken in, without admitting anything.
    [[nodiscard]] bool knows(std::string_view station) const;
    // The same; under `any` a new name is admitted while there is room, and stays admitted.
    [[nodiscard]] bool admits(std::string_view station);
    // The further stations that `any` has admitted, sorted.
    [[nodiscard]] std::vector<std::string> further() const;
    [[nodiscard]] std::size_t most_further() const { return most_further_; }
    // The same rule, whatever either has admitted.
    bool operator==(const StationRule& other) const;

  private:
    Kind kind_ = Kind::known;
    std::size_t most_further_ = 0;
    std::set<std::string, std::less<>> listed_;
    mutable std::mutex mutex_;  // guards further_
    std::set<std::string, std::less<>> further_;
};

}  // namespace stormcellar
