#include "base/bytes.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace pointreel {
namespace {

TEST(Bytes, NumbersComeBackInOrder) {
  ByteWriter writer;
  writer.put(std::uint8_t{7});
  writer.put(std::uint32_t{0x01020304});
  writer.put(-1.5);
  EXPECT_EQ(writer.size(), 13u);
  EXPECT_EQ(writer.bytes()[1], 4) << "little-endian";

  ByteReader reader(writer.bytes());
  EXPECT_EQ(reader.get<std::uint8_t>(), 7);
  EXPECT_EQ(reader.get<std::uint32_t>(), 0x01020304u);
  EXPECT_EQ(reader.get<double>(), -1.5);
  EXPECT_TRUE(reader.ok());
  EXPECT_TRUE(reader.rest().empty());
  EXPECT_TRUE(reader.ok()) << "an empty rest is no read past the end";
}

TEST(Bytes, AReadPastTheEndGivesZerosFromThenOn) {
  const std::vector<std::uint8_t> bytes = {1, 2, 3};
  ByteReader reader(bytes);
  EXPECT_EQ(reader.get<std::uint16_t>(), 0x0201);
  EXPECT_EQ(reader.get<std::uint16_t>(), 0) << "one byte is left, not two";
  EXPECT_FALSE(reader.ok());
  EXPECT_EQ(reader.get<std::uint8_t>(), 0) << "nothing is read after a failure";
  EXPECT_TRUE(reader.rest().empty());
  EXPECT_FALSE(reader.ok());
}

TEST(Bytes, AbsurdCountsDoNotOverflow) {
  const std::vector<std::uint8_t> bytes(16, 1);
  for (const std::size_t count : {std::size_t{16}, std::numeric_limits<std::size_t>::max()}) {
    ByteReader reader(bytes);
    reader.get<std::uint8_t>();
    EXPECT_TRUE(reader.get(count).empty());
    EXPECT_FALSE(reader.ok());
  }
}

TEST(Bytes, AnEmptyInputHoldsNothing) {
  ByteReader reader({});
  EXPECT_TRUE(reader.get(0).empty());
  EXPECT_TRUE(reader.ok());
  EXPECT_EQ(reader.get<std::uint64_t>(), 0u);
  EXPECT_FALSE(reader.ok());
}

}  // namespace
}  // namespace pointreel
