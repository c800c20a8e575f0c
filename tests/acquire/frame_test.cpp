// What the worker says, cut into frames, however the pipe delivers it.
#include "acquire/detail/frame.h"

#include <array>

#include <gtest/gtest.h>
#include <unistd.h>

namespace striae::acquire::detail {
namespace {

std::vector<std::uint8_t> Written(const Frame& frame) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
  EXPECT_TRUE(WriteFrame(ends[1], frame));
  ::close(ends[1]);
  std::vector<std::uint8_t> bytes(4096);
  bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(0, ::read(ends[0], bytes.data(), bytes.size()))));
  ::close(ends[0]);
  return bytes;
}

TEST(Frame, ArrivesWholeByteByByte) {
  const Frame sent{{{"tag", "file"}, {"name", "DSC_0001.JPG"}}, {0xFF, 0xD8, 0x00, 0xFF, 0xD9}};
  const auto bytes = Written(sent);
  FrameParser parser;
  for (std::size_t i = 0; i + 1 < bytes.size(); ++i) {
    parser.Append(&bytes[i], 1);
    ASSERT_FALSE(parser.Next()) << "after " << i + 1 << " of " << bytes.size() << " bytes";
  }
  parser.Append(&bytes.back(), 1);
  const auto frame = parser.Next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->header, sent.header);
  EXPECT_EQ(frame->bytes, sent.bytes);
  EXPECT_FALSE(parser.Next());
}

TEST(Frame, NamesThatAreNotTextDoNotLoseThePhotograph) {
  const auto bytes = Written({{{"tag", "file"}, {"name", "DSC\xFF.JPG"}}, {1}});
  FrameParser parser;
  parser.Append(bytes.data(), bytes.size());
  EXPECT_TRUE(parser.Next());
}

TEST(Frame, NonsenseIsNoticed) {
  for (const std::vector<std::uint8_t>& nonsense :
       {std::vector<std::uint8_t>(16, 0xFF), {2, 0, 0, 0, 0, 0, 0, 0, 'h', 'i'}, {2, 0, 0, 0, 0, 0, 0, 0, '{', '}'}}) {
    FrameParser parser;
    parser.Append(nonsense.data(), nonsense.size());
    EXPECT_FALSE(parser.Next());
    EXPECT_TRUE(parser.broken());
  }
}

}  // namespace
}  // namespace striae::acquire::detail
