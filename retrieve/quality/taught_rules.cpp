// The rules that bench/teach_quality.cpp printed; it says which volumes taught them. Do not edit
// the numbers.
#include "retrieve/quality/additive_rule.h"

namespace stormcellar::retrieve {
namespace {

constexpr std::array dual_reflectivity = {
    Knot{-20.00F, -1.034F}, Knot{-10.00F, -0.867F}, Knot{-5.00F, -0.895F}, Knot{0.00F, -0.503F},
    Knot{5.00F, -0.883F},   Knot{10.00F, -0.417F},  Knot{15.00F, -0.612F}, Knot{20.00F, 0.146F},
    Knot{25.00F, 1.575F},   Knot{30.00F, 1.292F},   Knot{40.00F, 1.294F},  Knot{50.00F, 0.904F},
};
constexpr std::array dual_correlation = {
    Knot{0.20F, -4.276F}, Knot{0.40F, -6.063F}, Knot{0.60F, -3.539F}, Knot{0.70F, -2.161F},
    Knot{0.75F, -1.603F}, Knot{0.80F, -0.858F}, Knot{0.85F, 0.040F},  Knot{0.90F, 1.065F},
    Knot{0.93F, 1.829F},  Knot{0.95F, 2.524F},  Knot{0.97F, 3.274F},  Knot{0.99F, 4.858F},
    Knot{1.05F, 4.910F},
};
constexpr std::array dual_zdr_texture = {
    Knot{0.00F, -0.040F}, Knot{0.25F, 0.397F},  Knot{0.50F, 0.723F},  Knot{1.00F, 0.274F},
    Knot{1.50F, 0.011F},  Knot{2.00F, -0.061F}, Knot{3.00F, -0.054F}, Knot{4.00F, -0.171F},
    Knot{6.00F, -0.463F}, Knot{8.00F, -0.581F},
};
constexpr std::array dual_phase_texture = {
    Knot{0.00F, -0.127F},  Knot{2.00F, 0.341F},   Knot{4.00F, 0.367F},   Knot{7.00F, 0.023F},
    Knot{10.00F, -0.266F}, Knot{15.00F, -0.461F}, Knot{20.00F, -0.366F}, Knot{30.00F, -0.093F},
    Knot{50.00F, 0.263F},  Knot{80.00F, 0.354F},
};
constexpr std::array dual_terms = {
    RuleTerm{Feature::reflectivity, 0.000F, dual_reflectivity},
    RuleTerm{Feature::correlation, 0.000F, dual_correlation},
    RuleTerm{Feature::zdr_texture, -0.034F, dual_zdr_texture},
    RuleTerm{Feature::phase_texture, -0.034F, dual_phase_texture},
};
constexpr AdditiveRule dual_rule{-1.791F, dual_terms};

constexpr std::array single_reflectivity = {
    Knot{-20.00F, -1.777F}, Knot{-10.00F, -1.259F}, Knot{-5.00F, -1.120F}, Knot{0.00F, -0.878F},
    Knot{5.00F, -0.921F},   Knot{10.00F, -0.313F},  Knot{15.00F, -0.374F}, Knot{20.00F, 0.399F},
    Knot{25.00F, 1.804F},   Knot{30.00F, 1.707F},   Knot{40.00F, 1.762F},  Knot{50.00F, 0.970F},
};
constexpr std::array single_height = {
    Knot{0.00F, -0.336F},    Knot{250.00F, -1.642F},  Knot{500.00F, -1.935F},
    Knot{1000.00F, -1.520F}, Knot{1500.00F, -1.543F}, Knot{2000.00F, -0.508F},
    Knot{3000.00F, 1.087F},  Knot{4000.00F, 1.403F},  Knot{6000.00F, 2.279F},
    Knot{8000.00F, 1.883F},  Knot{12000.00F, 0.832F},
};
constexpr std::array single_range_texture = {
    Knot{0.00F, -0.598F}, Knot{1.00F, -0.217F}, Knot{2.00F, 0.063F}, Knot{3.00F, 0.046F},
    Knot{4.00F, 0.144F},  Knot{5.00F, 0.158F},  Knot{7.00F, 0.346F}, Knot{10.00F, 0.442F},
};
constexpr std::array single_azimuth_texture = {
    Knot{0.00F, -0.213F}, Knot{1.00F, -0.072F}, Knot{2.00F, 0.114F}, Knot{3.00F, 0.197F},
    Knot{4.00F, 0.198F},  Knot{5.00F, 0.171F},  Knot{7.00F, 0.071F}, Knot{10.00F, -0.194F},
};
constexpr std::array single_echo_share = {
    Knot{0.00F, 0.618F},  Knot{0.10F, 0.360F},  Knot{0.20F, 0.073F},  Knot{0.40F, -0.309F},
    Knot{0.60F, -0.669F}, Knot{0.80F, -0.270F}, Knot{0.95F, -0.006F}, Knot{1.00F, 0.204F},
};
constexpr std::array single_mean_reflectivity = {
    Knot{-20.00F, 0.809F}, Knot{-10.00F, -0.244F}, Knot{-5.00F, -0.616F}, Knot{0.00F, -0.935F},
    Knot{5.00F, -1.701F},  Knot{10.00F, -1.224F},  Knot{15.00F, -1.745F}, Knot{20.00F, -0.257F},
    Knot{25.00F, 1.000F},  Knot{30.00F, 0.961F},   Knot{40.00F, 2.535F},  Knot{50.00F, 1.416F},
};
constexpr std::array single_reflectivity_above = {
    Knot{-20.00F, -1.126F}, Knot{-10.00F, -0.547F}, Knot{-5.00F, -0.025F}, Knot{0.00F, 0.526F},
    Knot{5.00F, 0.195F},    Knot{10.00F, 0.090F},   Knot{15.00F, -0.322F}, Knot{20.00F, 0.920F},
    Knot{25.00F, 0.561F},   Knot{30.00F, -0.537F},  Knot{40.00F, -0.036F}, Knot{50.00F, 1.071F},
};
constexpr std::array single_speed = {
    Knot{0.00F, -1.120F}, Knot{0.50F, -0.934F}, Knot{1.00F, -0.514F},
    Knot{2.00F, 0.019F},  Knot{3.00F, 0.222F},  Knot{5.00F, 0.805F},
    Knot{10.00F, 0.410F}, Knot{20.00F, 0.833F}, Knot{30.00F, 0.287F},
};
constexpr std::array single_speed_texture = {
    Knot{0.00F, 0.069F},  Knot{0.50F, 0.731F},  Knot{1.00F, 0.610F},
    Knot{1.50F, 0.238F},  Knot{2.00F, -0.117F}, Knot{3.00F, -0.679F},
    Knot{4.00F, -0.556F}, Knot{6.00F, -0.316F}, Knot{10.00F, -0.219F},
};
constexpr std::array single_width = {
    Knot{0.00F, 0.477F},  Knot{0.50F, 1.336F},  Knot{1.00F, 1.215F},
    Knot{1.50F, 0.743F},  Knot{2.00F, 0.426F},  Knot{3.00F, -0.064F},
    Knot{4.00F, -0.988F}, Knot{6.00F, -1.508F}, Knot{10.00F, -2.142F},
};
constexpr std::array single_speed_share = {
    Knot{0.00F, -0.565F}, Knot{0.10F, -0.364F}, Knot{0.20F, -0.285F}, Knot{0.40F, -0.237F},
    Knot{0.60F, 0.206F},  Knot{0.80F, 0.334F},  Knot{0.95F, 0.411F},  Knot{1.00F, 0.397F},
};
constexpr std::array single_terms = {
    RuleTerm{Feature::reflectivity, 0.000F, single_reflectivity},
    RuleTerm{Feature::height, 0.000F, single_height},
    RuleTerm{Feature::range_texture, -0.384F, single_range_texture},
    RuleTerm{Feature::azimuth_texture, -0.271F, single_azimuth_texture},
    RuleTerm{Feature::echo_share, 0.000F, single_echo_share},
    RuleTerm{Feature::mean_reflectivity, 0.000F, single_mean_reflectivity},
    RuleTerm{Feature::reflectivity_above, -0.770F, single_reflectivity_above},
    RuleTerm{Feature::speed, -0.008F, single_speed},
    RuleTerm{Feature::speed_texture, 0.240F, single_speed_texture},
    RuleTerm{Feature::width, 0.507F, single_width},
    RuleTerm{Feature::speed_share, 0.104F, single_speed_share},
};
constexpr AdditiveRule single_rule{0.704F, single_terms};

}  // namespace

const AdditiveRule& taught_rule(QualityRule rule) {
    return rule == QualityRule::dual ? dual_rule : single_rule;
}

}  // namespace stormcellar::retrieve
