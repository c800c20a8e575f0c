#include "report/detail/thumbnail.h"

#include "report/picture.h"

namespace striae::report::detail {

Result<Thumbnail> MakeThumbnail(const std::vector<std::uint8_t>& picture) {
  constexpr int kSide = 760;
  constexpr int kQuality = 90;
  auto image = DecodePicture(picture);
  if (!image) return Fail(image.error());
  const ImageRgb small = ShrinkToFit(*image, kSide, kSide);
  auto jpeg = EncodeJpeg(small, kQuality);
  if (!jpeg) return Fail(jpeg.error());
  return Thumbnail{small.width(), small.height(), *std::move(jpeg)};
}

}  // namespace striae::report::detail
