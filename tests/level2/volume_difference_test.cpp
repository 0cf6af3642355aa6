#include "stormcellar/level2/volume_difference.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "stormcellar/level2/decode.h"
#include "tests/level2/wire.h"

namespace stormcellar::level2 {
namespace {

Volume small_volume() {
    return decode(wire::ldm_volume(2, 3, 10)).value().volume;
}

TEST(VolumeDifference, AVolumeIsNoOtherThanItself) {
    Volume volume = small_volume();
    EXPECT_EQ(difference(volume, volume), "");
    volume.sweeps[0].radials[0].elevation_deg = std::nanf("");
    volume.block->latitude_deg = std::nanf("");
    EXPECT_EQ(difference(volume, volume), "");
}

TEST(VolumeDifference, NamesTheFirst) {
    struct Case {
        const char* where;
        std::function<void(Volume&)> change;
    };
    const std::vector<Case> cases = {
        {"header", [](Volume& v) { v.header.reset(); }},
        {"header: day", [](Volume& v) { ++v.header->date; }},
        {"volume data block: tower height", [](Volume& v) { ++v.block->tower_height_m; }},
        {"volume data block: rest", [](Volume& v) { v.block->rest.push_back(1); }},
        {"VCP", [](Volume& v) { v.vcp_message.reset(); }},
        {"VCP: sequencing", [](Volume& v) { ++v.vcp_message->sequencing; }},
        {"VCP, cut 1", [](Volume& v) { v.vcp_message->cuts.pop_back(); }},
        {"VCP, cut 1: Doppler sectors", [](Volume& v) { ++v.vcp_message->cuts[1].rest[7]; }},
        {"station", [](Volume& v) { v.station = "KLOT"; }},
        {"VCP number", [](Volume& v) { v.vcp.reset(); }},
        {"source of the VCP number", [](Volume& v) { v.vcp_source = VcpSource::radial; }},
        {"sweep 1", [](Volume& v) { v.sweeps.pop_back(); }},
        {"sweep 2", [](Volume& v) { v.sweeps.emplace_back(); }},
        {"sweep 1: fixed angle", [](Volume& v) { v.sweeps[1].vcp_elevation_deg = 9; }},
        {"sweep 1, radial 2", [](Volume& v) { v.sweeps[1].radials.pop_back(); }},
        {"sweep 0, radial 0: azimuth",
         [](Volume& v) { v.sweeps[0].radials[0].azimuth_deg = -0.0F; }},
        {"sweep 1, radial 2: status", [](Volume& v) { ++v.sweeps[1].radials[2].status; }},
        {"sweep 1, radial 2: calibration",
         [](Volume& v) { v.sweeps[1].radials[2].calibration_dbz.reset(); }},
        {"sweep 1, moment 1", [](Volume& v) { v.sweeps[1].moments.pop_back(); }},
        {"sweep 1, moment 1: scale", [](Volume& v) { v.sweeps[1].moments[1].scale = 2; }},
        {"sweep 1, moment 1: codes", [](Volume& v) { ++v.sweeps[1].moments[1].codes16[29]; }},
        {"sweep 0, moment 0: number of gates",
         [](Volume& v) { --v.sweeps[0].moments[0].gate_counts[1]; }},
    };
    const Volume volume = small_volume();
    for (const Case& each : cases) {
        Volume other = volume;
        each.change(other);
        EXPECT_EQ(difference(volume, other), each.where);
        EXPECT_EQ(difference(other, volume), each.where);
    }
}

}  // namespace
}  // namespace stormcellar::level2
