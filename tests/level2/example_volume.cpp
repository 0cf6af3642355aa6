#include "tests/level2/example_volume.h"

namespace stormcellar::level2 {

SweepMoment moment_of(Moment name, std::size_t radials, std::int32_t gates, int bits) {
    SweepMoment moment;
    moment.moment = name;
    moment.first_gate_m = 2125;
    moment.gate_spacing_m = 250;
    moment.gate_stride = gates;
    moment.word_size_bits = bits;
    moment.scale = 2;
    moment.offset = 66;
    moment.snr_threshold_db = 2;
    moment.folding_threshold_db = 5;
    moment.gate_counts.assign(radials, static_cast<std::uint16_t>(gates));
    const std::size_t codes = radials * static_cast<std::size_t>(gates);
    for (std::size_t i = 0; i < codes; ++i) {
        if (bits == 8) {
            moment.codes8.push_back(static_cast<std::uint8_t>(i * 7 % 256));
        } else {
            moment.codes16.push_back(static_cast<std::uint16_t>(i * 77 % 65536));
        }
    }
    return moment;
}

namespace {

Radial radial_of(std::size_t index, std::size_t count, bool first_sweep, bool last_sweep) {
    Radial radial;
    radial.time = time_from_nexrad(19069, 86'399'900) + std::chrono::milliseconds(30 * index);
    radial.azimuth_deg = static_cast<float>(index) + 0.25F;
    radial.elevation_deg = -0.25F;
    radial.nyquist_mps = 28.34F;
    radial.unambiguous_range_m = 137000;
    radial.calibration_dbz = -42.9F;
    radial.horizontal_noise_dbm = -81.5F;
    radial.vertical_noise_dbm = -81.25F;
    radial.vertical_calibration_dbz = -42.5F;
    radial.azimuth_number = static_cast<std::uint16_t>(index + 1);
    radial.status = 1;
    if (index == 0) radial.status = first_sweep ? 3 : 0;
    if (index + 1 == count) radial.status = last_sweep ? 4 : 2;
    radial.cut_sector = 1;
    radial.spot_blanking = 2;
    radial.azimuth_indexing = 25;
    radial.radial_flags = 5;
    radial.attenuation_db_per_km_thousandths = std::int16_t{-12};
    radial.elevation_calibration_db = -43.0F;
    return radial;
}

VcpCut cut_of(float elevation_deg) {
    VcpCut cut;
    cut.elevation_deg = elevation_deg;
    cut.channel_configuration = 2;
    cut.waveform = 1;
    cut.super_resolution = 11;
    cut.surveillance_prf = 1;
    cut.surveillance_pulses = 15;
    cut.azimuth_rate_code = -15400;
    cut.supplemental = 0x35;
    cut.thresholds_eighth_db = {16, -16, 28, 1, 2, 3};
    for (std::size_t i = 0; i < cut.rest.size(); ++i)
        cut.rest[i] = static_cast<std::uint8_t>(i + 1);
    return cut;
}

}  // namespace

Volume example_volume() {
    Volume volume;
    volume.header = VolumeHeader{"AR2V0006.116", 19070, 900, "KLOT"};
    volume.station = "KLOT";
    volume.block = VolumeBlock{};
    volume.block->size_bytes = 52;
    volume.block->version_major = 3;
    volume.block->latitude_deg = 41.6F;
    volume.block->longitude_deg = -88.08F;
    volume.block->site_height_m = -20;
    volume.block->tower_height_m = 29;
    volume.block->vcp = 212;
    volume.block->rest = {1, 2, 3, 4, 5, 6, 7, 8};
    volume.vcp_message = Vcp{};
    volume.vcp_message->pattern_number = 212;
    volume.vcp_message->version = 1;
    volume.vcp_message->doppler_resolution = 2;
    volume.vcp_message->pulse_width = 2;
    volume.vcp_message->sequencing = 7;
    volume.vcp_message->supplemental = 0x70;
    volume.vcp_message->cuts = {cut_of(0.483398438F), cut_of(static_cast<float>(-180.0 / 32768))};
    volume.vcp = 212;
    volume.vcp_source = VcpSource::message_5;
    for (const int number : {1, 2}) {
        Sweep sweep;
        sweep.elevation_number = number;
        sweep.azimuth_spacing_deg = number == 1 ? 0.5F : 1.0F;
        sweep.vcp_elevation_deg =
            volume.vcp_message->cuts[static_cast<std::size_t>(number - 1)].elevation_deg;
        const std::size_t count = 130;
        for (std::size_t i = 0; i < count; ++i)
            sweep.radials.push_back(radial_of(i, count, number == 1, number == 2));
        sweep.moments.push_back(moment_of(Moment::ref, count, 101, 8));
        sweep.moments.push_back(moment_of(Moment::sw, count, 33, 8));
        sweep.moments.push_back(moment_of(Moment::phi, count, 40, 16));
        volume.sweeps.push_back(sweep);
    }
    return volume;
}

}  // namespace stormcellar::level2
