#include "tests/fault/cut_gates.h"

#include <utility>
#include <vector>

namespace stormcellar::fault {

void cut_gates(level2::Volume& volume, std::uint16_t gates) {
    for (level2::Sweep& sweep : volume.sweeps) {
        for (level2::SweepMoment& moment : sweep.moments) {
            std::vector<std::uint8_t> codes;
            for (std::size_t radial = 0; radial < moment.gate_counts.size(); ++radial) {
                for (int gate = 0; gate < gates; ++gate)
                    codes.push_back(static_cast<std::uint8_t>(moment.code(radial, gate)));
                moment.gate_counts[radial] = gates;
            }
            moment.codes8 = std::move(codes);
            moment.gate_stride = gates;
        }
    }
}

}  // namespace stormcellar::fault
