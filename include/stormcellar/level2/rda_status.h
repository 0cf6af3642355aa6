// stormcellar/level2/rda_status.h -- the status that a radar reports about itself in message 2 (ICD
// 2620002, table IV).
//
// Units     Each member names its unit.
// Threads   Plain data and a pure function.
// Errors    None; unknown codes are kept.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/utc_time.h"

namespace stormcellar::level2 {

// States of the radar. The decoder also keeps codes that no ICD names.
enum class RdaState : std::uint16_t {
    start_up = 2,
    standby = 4,
    restart = 8,
    operate = 16,
    playback = 32,          // before build 7 only
    off_line_operate = 64,  // up to build 18
};

// Flags. A radar without trouble has only on_line.
namespace rda_operability {
inline constexpr std::uint16_t calibration_disabled = 1;  // up to build 13
inline constexpr std::uint16_t on_line = 2;
inline constexpr std::uint16_t maintenance_required = 4;
inline constexpr std::uint16_t maintenance_mandatory = 8;
inline constexpr std::uint16_t commanded_shut_down = 16;
inline constexpr std::uint16_t inoperable = 32;
}  // namespace rda_operability

namespace rda_power {
inline constexpr std::uint16_t on_auxiliary_power = 1;
inline constexpr std::uint16_t utility_power_available = 2;
inline constexpr std::uint16_t generator_on = 4;
inline constexpr std::uint16_t transfer_switch_manual = 8;
inline constexpr std::uint16_t commanded_switchover = 16;
}  // namespace rda_power

namespace rda_data {
inline constexpr std::uint16_t none = 2;
inline constexpr std::uint16_t reflectivity = 4;
inline constexpr std::uint16_t velocity = 8;
inline constexpr std::uint16_t width = 16;
}  // namespace rda_data

// The mode in which the radar runs. The meaning of code 2 has changed over the years, so the
// decoder translates it.
enum class RdaMode : std::uint8_t { unknown, operational, maintenance, test };

// An alarm that was raised or, if `cleared`, has ended (table IV-A). A message has up to 14 alarms.
struct RdaAlarm {
    std::uint16_t code = 0;
    bool cleared = false;
};

struct RdaStatus {
    bool legacy = false;  // from an RDA before the Open RDA
    RdaState state = RdaState::operate;
    std::uint16_t operability = 0;                // rda_operability
    std::uint16_t control = 0;                    // 2 local only, 4 RPG only, 8 either
    std::uint16_t power = 0;                      // rda_power
    std::uint16_t transmitter_w = 0;              // average power, W
    float horizontal_correction_db = 0;           // measured dBZ0 minus the adaptation data's dBZ0
    std::optional<float> vertical_correction_db;  // from build 13 on
    std::uint16_t data_enabled = 0;               // rda_data
    int vcp = 0;                                  // 0: none
    bool vcp_is_local = false;                    // chosen at the RDA, not by the RPG
    std::uint16_t control_request = 0;            // 0 none, 2 local control asked for, 4 remote
    std::optional<float> build;                   // such as 22.1; none from a legacy RDA
    RdaMode mode = RdaMode::unknown;

    std::optional<bool> super_resolution;        // from build 10 on
    std::optional<bool> clutter_decision;        // CMD, from build 10 on
    std::uint8_t clutter_decision_segments = 0;  // bit 0 is the lowest elevation segment
    std::optional<bool> avset;                   // from build 11 on
    std::optional<bool> elevation_correction;    // EBC, from build 18 on
    std::optional<bool> log_data;                // the RDA sends message 33; from build 19 on
    std::optional<bool> rho_hv_test;             // test of CMD; from build 19 on
    std::optional<bool> time_series_recording;   // from build 21 on
    // 0 none, 1 pending, 2 running; from build 14 on
    std::optional<std::uint16_t> performance_check;
    std::optional<int> downloaded_vcp;     // that the RDA acknowledged; from build 23 on
    std::optional<std::uint16_t> version;  // of the message; from build 19 on

    std::optional<std::uint16_t> interference_pulses_per_s;  // legacy
    std::optional<bool> interference_suppression;            // legacy
    std::optional<std::uint16_t> recorder;                   // legacy: flags of the tape drive
    std::optional<std::uint16_t> recorder_volumes_left;      // legacy

    std::uint16_t alarm_summary = 0;  // flags, see rda_troubles
    std::vector<RdaAlarm> alarms;
    std::uint16_t acknowledged = 0;  // 1 VCP, 2 bypass map, 3 censor zones, 4 channel command
    bool controlling_channel = true;
    std::uint16_t spot_blanking = 0;         // 0 not installed, 2 on, 4 off
    std::optional<UtcTime> bypass_map_time;  // to the minute
    std::optional<UtcTime> clutter_map_time;
    std::uint16_t transition_power = 0;  // 0 not installed, 1 off, 3 OK, 4 unknown
    std::uint16_t rms_control = 0;       // 0 no RMS, 2 RMS, 4 RDA
};

// Returns the faults in short phrases, state and operability first: "standby", "maintenance
// required", "alarm 206". The result is empty for a radar that operates without trouble.
[[nodiscard]] std::vector<std::string> rda_troubles(const RdaStatus& status);

}  // namespace stormcellar::level2
