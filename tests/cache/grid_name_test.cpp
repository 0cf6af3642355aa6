#include "stormcellar/cache/grid_name.h"

#include <gtest/gtest.h>

namespace stormcellar::cache {
namespace {

TEST(GridName, DomainsAreNamesWithOrWithoutTheIcaoOfAPart) {
    const std::string longest(64, 'a');
    for (const std::string& name : {std::string{"KTLX"}, std::string{"north-east_2"}, longest,
                                    std::string{"northeast.KBOX"}, longest + ".T123"}) {
        EXPECT_TRUE(is_domain_name(name)) << name;
    }
    for (const std::string& name :
         {std::string{}, std::string{"."}, std::string{".."}, std::string{".KBOX"},
          std::string{"a."}, std::string{"a.kbox"}, std::string{"a.KBO"}, std::string{"a.KBOXX"},
          std::string{"a.1BOX"}, std::string{"a.KBOX.KOKX"}, std::string{"a/b"},
          std::string{"a.K/XX"}, std::string{"-a"}, longest + "a"}) {
        EXPECT_FALSE(is_domain_name(name)) << name;
    }
    EXPECT_EQ(group_of("northeast"), "northeast");
    EXPECT_EQ(group_of("northeast.KBOX"), "northeast");
    EXPECT_TRUE(is_part("northeast.KBOX"));
    EXPECT_FALSE(is_part("northeast"));
}

TEST(GridName, PathsHoldTheTimeToTheMillisecond) {
    const UtcTime time = *parse_utc("2022-03-17T00:08:42.596Z", UtcTime{});
    const GridName name{"northeast.KBOX", level2::Moment::ref, time};
    EXPECT_EQ(relative_path(name),
              "northeast.KBOX/REF/20220317/northeast.KBOX_REF_20220317_000842_596.scg");
    const auto back = [&](std::string_view file) {
        return time_in_file_name(name.domain, name.moment, file);
    };
    EXPECT_EQ(back("northeast.KBOX_REF_20220317_000842_596.scg"), time);
    for (const char* other :
         {"northeast.KBOX_REF_20220317_000842_596.scg.pin",
          "northeast.KBOX_REF_20220317_000842_59x.scg",
          "northeast.KBOX_VEL_20220317_000842_596.scg", "northeast_REF_20220317_000842_596.scg",
          "northeast.KBOX_REF_20220317_000842-596.scg"}) {
        EXPECT_FALSE(back(other)) << other;
    }
}

}  // namespace
}  // namespace stormcellar::cache
