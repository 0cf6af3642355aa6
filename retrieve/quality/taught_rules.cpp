// The rules that bench/teach_quality.cpp printed. That file says which volumes taught the rules. Do
// not edit the numbers.
#include "retrieve/quality/additive_rule.h"

namespace stormcellar::retrieve {
namespace {

constexpr std::array dual_reflectivity = {
    Knot{-20.00F, -1.136F}, Knot{-10.00F, -0.953F}, Knot{-5.00F, -0.986F}, Knot{0.00F, -0.609F},
    Knot{5.00F, -1.009F},   Knot{10.00F, -0.480F},  Knot{15.00F, -0.751F}, Knot{20.00F, 0.112F},
    Knot{25.00F, 1.449F},   Knot{30.00F, 1.176F},   Knot{40.00F, 1.708F},  Knot{50.00F, 1.480F},
};
constexpr std::array dual_correlation = {
    Knot{0.20F, -4.291F}, Knot{0.40F, -6.034F}, Knot{0.60F, -3.535F}, Knot{0.70F, -2.155F},
    Knot{0.75F, -1.604F}, Knot{0.80F, -0.864F}, Knot{0.85F, 0.056F},  Knot{0.90F, 1.046F},
    Knot{0.93F, 1.822F},  Knot{0.95F, 2.490F},  Knot{0.97F, 3.261F},  Knot{0.99F, 4.850F},
    Knot{1.05F, 4.957F},
};
constexpr std::array dual_zdr_texture = {
    Knot{0.00F, -0.048F}, Knot{0.25F, 0.392F},  Knot{0.50F, 0.727F},  Knot{1.00F, 0.268F},
    Knot{1.50F, 0.012F},  Knot{2.00F, -0.052F}, Knot{3.00F, -0.037F}, Knot{4.00F, -0.153F},
    Knot{6.00F, -0.485F}, Knot{8.00F, -0.578F},
};
constexpr std::array dual_phase_texture = {
    Knot{0.00F, -0.129F},  Knot{2.00F, 0.347F},   Knot{4.00F, 0.352F},   Knot{7.00F, 0.042F},
    Knot{10.00F, -0.270F}, Knot{15.00F, -0.446F}, Knot{20.00F, -0.344F}, Knot{30.00F, -0.106F},
    Knot{50.00F, 0.243F},  Knot{80.00F, 0.357F},
};
constexpr std::array dual_terms = {
    RuleTerm{Feature::reflectivity, 0.000F, dual_reflectivity},
    RuleTerm{Feature::correlation, 0.000F, dual_correlation},
    RuleTerm{Feature::zdr_texture, -0.047F, dual_zdr_texture},
    RuleTerm{Feature::phase_texture, -0.047F, dual_phase_texture},
};
constexpr AdditiveRule dual_rule{-1.774F, dual_terms};

constexpr std::array single_reflectivity = {
    Knot{-20.00F, -1.815F}, Knot{-10.00F, -1.294F}, Knot{-5.00F, -1.166F}, Knot{0.00F, -0.922F},
    Knot{5.00F, -0.967F},   Knot{10.00F, -0.340F},  Knot{15.00F, -0.447F}, Knot{20.00F, 0.407F},
    Knot{25.00F, 1.760F},   Knot{30.00F, 1.722F},   Knot{40.00F, 1.828F},  Knot{50.00F, 1.234F},
};
constexpr std::array single_height = {
    Knot{0.00F, -0.338F},    Knot{250.00F, -1.641F},  Knot{500.00F, -1.939F},
    Knot{1000.00F, -1.525F}, Knot{1500.00F, -1.552F}, Knot{2000.00F, -0.515F},
    Knot{3000.00F, 1.060F},  Knot{4000.00F, 1.384F},  Knot{6000.00F, 2.341F},
    Knot{8000.00F, 1.868F},  Knot{12000.00F, 0.858F},
};
constexpr std::array single_range_texture = {
    Knot{0.00F, -0.599F}, Knot{1.00F, -0.209F}, Knot{2.00F, 0.067F}, Knot{3.00F, 0.046F},
    Knot{4.00F, 0.157F},  Knot{5.00F, 0.153F},  Knot{7.00F, 0.345F}, Knot{10.00F, 0.446F},
};
constexpr std::array single_azimuth_texture = {
    Knot{0.00F, -0.200F}, Knot{1.00F, -0.074F}, Knot{2.00F, 0.109F}, Knot{3.00F, 0.206F},
    Knot{4.00F, 0.185F},  Knot{5.00F, 0.160F},  Knot{7.00F, 0.071F}, Knot{10.00F, -0.185F},
};
constexpr std::array single_echo_share = {
    Knot{0.00F, 0.615F},  Knot{0.10F, 0.363F},  Knot{0.20F, 0.069F},  Knot{0.40F, -0.312F},
    Knot{0.60F, -0.668F}, Knot{0.80F, -0.258F}, Knot{0.95F, -0.015F}, Knot{1.00F, 0.207F},
};
constexpr std::array single_mean_reflectivity = {
    Knot{-20.00F, 0.843F}, Knot{-10.00F, -0.214F}, Knot{-5.00F, -0.589F}, Knot{0.00F, -0.908F},
    Knot{5.00F, -1.663F},  Knot{10.00F, -1.180F},  Knot{15.00F, -1.713F}, Knot{20.00F, -0.249F},
    Knot{25.00F, 1.004F},  Knot{30.00F, 0.938F},   Knot{40.00F, 2.409F},  Knot{50.00F, 1.323F},
};
constexpr std::array single_reflectivity_above = {
    Knot{-20.00F, -1.124F}, Knot{-10.00F, -0.537F}, Knot{-5.00F, 0.013F},  Knot{0.00F, 0.558F},
    Knot{5.00F, 0.157F},    Knot{10.00F, 0.105F},   Knot{15.00F, -0.332F}, Knot{20.00F, 0.897F},
    Knot{25.00F, 0.592F},   Knot{30.00F, -0.526F},  Knot{40.00F, -0.073F}, Knot{50.00F, 1.037F},
};
constexpr std::array single_speed = {
    Knot{0.00F, -1.127F}, Knot{0.50F, -0.951F}, Knot{1.00F, -0.517F},
    Knot{2.00F, 0.010F},  Knot{3.00F, 0.232F},  Knot{5.00F, 0.793F},
    Knot{10.00F, 0.403F}, Knot{20.00F, 0.841F}, Knot{30.00F, 0.338F},
};
constexpr std::array single_speed_texture = {
    Knot{0.00F, 0.071F},  Knot{0.50F, 0.715F},  Knot{1.00F, 0.624F},
    Knot{1.50F, 0.248F},  Knot{2.00F, -0.111F}, Knot{3.00F, -0.666F},
    Knot{4.00F, -0.567F}, Knot{6.00F, -0.287F}, Knot{10.00F, -0.226F},
};
constexpr std::array single_width = {
    Knot{0.00F, 0.488F},  Knot{0.50F, 1.330F},  Knot{1.00F, 1.224F},
    Knot{1.50F, 0.732F},  Knot{2.00F, 0.427F},  Knot{3.00F, -0.089F},
    Knot{4.00F, -0.972F}, Knot{6.00F, -1.506F}, Knot{10.00F, -2.136F},
};
constexpr std::array single_speed_share = {
    Knot{0.00F, -0.523F}, Knot{0.10F, -0.379F}, Knot{0.20F, -0.270F}, Knot{0.40F, -0.253F},
    Knot{0.60F, 0.190F},  Knot{0.80F, 0.316F},  Knot{0.95F, 0.388F},  Knot{1.00F, 0.382F},
};
constexpr std::array single_terms = {
    RuleTerm{Feature::reflectivity, 0.000F, single_reflectivity},
    RuleTerm{Feature::height, 0.000F, single_height},
    RuleTerm{Feature::range_texture, -0.405F, single_range_texture},
    RuleTerm{Feature::azimuth_texture, -0.272F, single_azimuth_texture},
    RuleTerm{Feature::echo_share, 0.000F, single_echo_share},
    RuleTerm{Feature::mean_reflectivity, 0.000F, single_mean_reflectivity},
    RuleTerm{Feature::reflectivity_above, -0.766F, single_reflectivity_above},
    RuleTerm{Feature::speed, -0.023F, single_speed},
    RuleTerm{Feature::speed_texture, 0.200F, single_speed_texture},
    RuleTerm{Feature::width, 0.502F, single_width},
    RuleTerm{Feature::speed_share, 0.147F, single_speed_share},
};
constexpr AdditiveRule single_rule{0.727F, single_terms};

}  // namespace

const AdditiveRule& taught_rule(QualityRule rule) {
    return rule == QualityRule::dual ? dual_rule : single_rule;
}

}  // namespace stormcellar::retrieve
