#include "tests/level2/radial_identity.h"

#include "base/checksum.h"
#include "level2/messages/byte_writer.h"

namespace stormcellar::level2 {
namespace {

template <class Number>
void put(ByteWriter& out, const std::optional<Number>& number) {
    out.u8(number ? 1 : 0);
    if (!number) return;
    if constexpr (std::is_same_v<Number, float>) {
        out.f32(*number);
    } else {
        out.i16(*number);
    }
}

void put_fields(ByteWriter& out, const Sweep& sweep, const Radial& radial) {
    out.u32(static_cast<std::uint32_t>(sweep.elevation_number));
    out.u32(static_cast<std::uint32_t>(sweep.message_type));
    const NexradTime time = nexrad_from_time(radial.time);
    out.u32(static_cast<std::uint32_t>(time.day));
    out.u32(static_cast<std::uint32_t>(time.milliseconds));
    for (const float number : {radial.azimuth_deg, radial.elevation_deg, radial.nyquist_mps,
                               radial.unambiguous_range_m}) {
        out.f32(number);
    }
    put(out, radial.calibration_dbz);
    put(out, radial.horizontal_noise_dbm);
    put(out, radial.vertical_noise_dbm);
    put(out, radial.attenuation_db_per_km_thousandths);
    put(out, radial.elevation_calibration_db);
    put(out, radial.vertical_calibration_dbz);
    for (const unsigned number :
         {unsigned{radial.azimuth_number}, unsigned{radial.status}, unsigned{radial.cut_sector},
          unsigned{radial.spot_blanking}, unsigned{radial.azimuth_indexing},
          unsigned{radial.radial_flags}}) {
        out.u16(static_cast<std::uint16_t>(number));
    }
}

void put_moment(ByteWriter& out, const SweepMoment& moment, std::size_t radial) {
    const std::size_t gates = moment.gate_counts[radial];
    const std::size_t row = radial * static_cast<std::size_t>(moment.gate_stride);
    out.u8(static_cast<std::uint8_t>(moment.moment));
    out.u32(static_cast<std::uint32_t>(moment.first_gate_m));
    out.u32(static_cast<std::uint32_t>(moment.gate_spacing_m));
    out.u32(static_cast<std::uint32_t>(moment.word_size_bits));
    out.f32(moment.scale);
    out.f32(moment.offset);
    out.u32(static_cast<std::uint32_t>(gates));
    if (moment.word_size_bits == 8) {
        out.raw(std::span{moment.codes8}.subspan(row, gates));
    } else {
        out.raw(std::as_bytes(std::span{moment.codes16}.subspan(row, gates)));
    }
}

}  // namespace

RadialIdentity identity(const Sweep& sweep, std::size_t radial) {
    ByteWriter out;
    put_fields(out, sweep, sweep.radials[radial]);
    // The order of the moments in a sweep depends on earlier radials; their names do not.
    for (const Moment name : all_moments) {
        for (const SweepMoment& moment : sweep.moments) {
            if (moment.moment == name && moment.gate_counts[radial] > 0)
                put_moment(out, moment, radial);
        }
    }
    return xxh3_64(out.bytes());
}

std::vector<RadialIdentity> identities(const Volume& volume) {
    std::vector<RadialIdentity> all;
    all.reserve(volume.radial_count());
    for (const Sweep& sweep : volume.sweeps) {
        for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial)
            all.push_back(identity(sweep, radial));
    }
    return all;
}

}  // namespace stormcellar::level2
