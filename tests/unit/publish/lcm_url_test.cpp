#include "publish/lcm_url.h"

#include <gmock/gmock.h>

#include "base/errors.h"

namespace bole {
namespace {

TEST(LcmUrl, DefaultStaysOnThisMachine) {
  const LcmUrl url = parse_lcm_url(kDefaultLcmUrl, "boled.toml", "lcm.url");
  EXPECT_EQ(url.address, "239.255.76.67");
  EXPECT_EQ(url.port, 7667);
  EXPECT_EQ(url.ttl, 0);
  EXPECT_EQ(url.text(), kDefaultLcmUrl);
}

TEST(LcmUrl, WithoutTtlItIsZero) {
  EXPECT_EQ(parse_lcm_url("udpm://224.1.2.3:9000", "", "").ttl, 0);
}

TEST(LcmUrl, RefusesWhatIsNotOne) {
  for (const char* url :
       {"", "udpm://", "tcpq://127.0.0.1:7700", "udpm://239.255.76.67", "udpm://10.0.0.1:7667",
        "udpm://239.255.76.67:0", "udpm://239.255.76.67:65536", "udpm://239.255.76.67:7667?ttl=256",
        "udpm://239.255.76.67:7667?ttl=-1", "udpm://239.255.76.999:7667",
        "udpm://239.255.76.67:7667?recv=1", "udpm://239.255.76.67:99999999999"}) {
    EXPECT_THAT([&] { parse_lcm_url(url, "boled.toml", "lcm.url"); },
                testing::ThrowsMessage<ConfigError>(testing::StartsWith("boled.toml: lcm.url")))
        << url;
  }
}

}  // namespace
}  // namespace bole
