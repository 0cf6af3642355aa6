#include "stormcellar/level2/rda_status.h"

#include <array>
#include <span>

#include <fmt/format.h>

namespace stormcellar::level2 {
namespace {

// A flag or a code, and the words for it.
struct Words {
    std::uint16_t code;
    const char* text;
};

void add_flags(std::vector<std::string>& troubles, std::uint16_t flags,
               std::span<const Words> words) {
    for (const Words& flag : words) {
        if ((flags & flag.code) != 0) troubles.emplace_back(flag.text);
    }
}

void add_state(std::vector<std::string>& troubles, RdaState state) {
    if (state == RdaState::operate) return;
    constexpr std::array words = {
        Words{2, "starting up"},        Words{4, "standby"},
        Words{8, "restarting"},         Words{32, "playback"},
        Words{64, "operates off line"},
    };
    const auto code = static_cast<std::uint16_t>(state);
    for (const Words& word : words) {
        if (word.code == code) {
            troubles.emplace_back(word.text);
            return;
        }
    }
    troubles.push_back(fmt::format("state {} is unknown", code));
}

constexpr std::array operability_words = {
    Words{rda_operability::inoperable, "inoperable"},
    Words{rda_operability::commanded_shut_down, "shut down by command"},
    Words{rda_operability::maintenance_mandatory, "maintenance mandatory"},
    Words{rda_operability::maintenance_required, "maintenance required"},
    Words{rda_operability::calibration_disabled, "automatic calibration off"},
};
constexpr std::array open_alarm_words = {
    Words{2, "tower or utilities alarm"}, Words{4, "pedestal alarm"},
    Words{8, "transmitter alarm"},        Words{16, "receiver alarm"},
    Words{32, "RDA control alarm"},       Words{64, "communication alarm"},
    Words{128, "signal processor alarm"},
};
constexpr std::array legacy_alarm_words = {
    Words{2, "tower or utilities alarm"},   Words{4, "pedestal alarm"},
    Words{8, "transmitter alarm"},          Words{16, "receiver or signal processor alarm"},
    Words{32, "RDA control alarm"},         Words{64, "RPG communication alarm"},
    Words{128, "user communication alarm"}, Words{256, "recorder alarm"},
};

void add_missing_data(std::vector<std::string>& troubles, std::uint16_t enabled) {
    constexpr std::array words = {
        Words{rda_data::reflectivity, "reflectivity off"},
        Words{rda_data::velocity, "velocity off"},
        Words{rda_data::width, "spectrum width off"},
    };
    add_flags(troubles, static_cast<std::uint16_t>(~enabled), words);
}

}  // namespace

std::vector<std::string> rda_troubles(const RdaStatus& status) {
    std::vector<std::string> troubles;
    add_state(troubles, status.state);
    add_flags(troubles, status.operability, operability_words);
    if (status.mode == RdaMode::maintenance) troubles.emplace_back("maintenance mode");
    if (status.mode == RdaMode::test) troubles.emplace_back("test mode");
    add_missing_data(troubles, status.data_enabled);
    if (status.legacy) {
        add_flags(troubles, status.alarm_summary, legacy_alarm_words);
    } else {
        add_flags(troubles, status.alarm_summary, open_alarm_words);
    }
    for (const RdaAlarm& alarm : status.alarms) {
        if (!alarm.cleared) troubles.push_back(fmt::format("alarm {}", alarm.code));
    }
    if ((status.power & rda_power::on_auxiliary_power) != 0)
        troubles.emplace_back("on auxiliary power");
    if (status.transition_power == 1) troubles.emplace_back("transition power source off");
    return troubles;
}

}  // namespace stormcellar::level2
