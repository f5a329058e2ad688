// SPDX-License-Identifier: Apache-2.0
#include "formats/nvm.h"

#include <gtest/gtest.h>

#include <string>

#include "io/temporary_folder.h"
#include "vdbfuse/base/errors.h"
#include "vdbfuse/io/png.h"

namespace vdbfuse {
namespace {

using test::messageOf;
using test::TemporaryFolder;
using test::writeText;

// A quarter turn about z: the camera's x is the world's y.
const std::string kCamera = "a.png 5 0.70710678118654757 0 0 -0.70710678118654757 1 2 3 0 0\n";

struct TinyFolder : TemporaryFolder {
  explicit TinyFolder(const std::string& text = "NVM_V3 \n\n1\n" + kCamera + "\n0\n") {
    writePng(*this / "a.png", Image<Rgb8>(4, 3, Rgb8{1, 2, 3}));
    writeText(*this / "model.nvm", text);
  }
  ImageSet read() const { return readNvm(path(), {}); }
  // The message without the folder's own name.
  std::string complaint() const {
    const std::string message = messageOf<IoError>([&] { read(); });
    EXPECT_EQ(message.find(path().string()), 0u) << message;
    return message.substr(path().string().size());
  }
};

std::string complaintAbout(const std::string& text) { return TinyFolder(text).complaint(); }

TEST(Nvm, QuaternionIsWorldToCameraAndTheCentreStated) {
  const TinyFolder folder;
  const PhotographHeader header = folder.read().photographs.header(0);
  EXPECT_EQ(header.camera, (Pinhole{4, 3, 5, 5, 1.5, 1, {}}));
  EXPECT_TRUE((header.world_from_camera * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(1, 3, 3)));
}

TEST(Nvm, OneCameraMayBeStatedForAll) {
  const TinyFolder folder("NVM_V3 FixedK 5 2.5 6 1.75 0\n1\n" + kCamera + "0\n");
  EXPECT_EQ(folder.read().photographs.header(0).camera, (Pinhole{4, 3, 5, 6, 2, 1.25, {}}));
}

TEST(Nvm, FurtherModelsAreLeftOut) {
  const TinyFolder folder("NVM_V3\n1\n" + kCamera + "0\n\n1\n" + kCamera + "0\n0\n");
  EXPECT_EQ(folder.read().photographs.size(), 1u);
  EXPECT_EQ(folder.read().notes, std::vector<std::string>{"models after the first left out"});
}

TEST(Nvm, BrokenFilesAreRefusedWithTheirLine) {
  EXPECT_EQ(complaintAbout("NVM_V3_R9T\n1\n"), "/model.nvm: line 1: expected 'NVM_V3', found 'NVM_V3_R9T'");
  EXPECT_EQ(complaintAbout("NVM_V3\n0\n"), "/model.nvm: line 2: expected at least one camera, found none");
  EXPECT_EQ(complaintAbout("NVM_V3\n2\n" + kCamera),
            "/model.nvm: line 4: expected the name of a picture, found the end of the file");
  EXPECT_EQ(complaintAbout("NVM_V3\n1\na.png 5 1 1 0 0 1 2 3 0 0\n0\n"),
            "/model.nvm: line 3: expected a quaternion of length 1, found length 1.41421");
  EXPECT_EQ(complaintAbout("NVM_V3\n1\nC:\\a.png 5 1 0 0 x 1 2 3 0 0\n0\n"),
            "/model.nvm: line 3: expected a number, found 'x'");
  EXPECT_EQ(complaintAbout("NVM_V3\n1\n../" + kCamera + "0\n"),
            "/model.nvm: line 3: expected a path inside the data set, found '../a.png'");
  EXPECT_EQ(complaintAbout("NVM_V3\n1\n" + kCamera + "1\n0 0 0 9 9 9 1 1 0 0 0\n"),
            "/model.nvm: line 5: expected a whole number from 0 to 0, found '1'");
}

}  // namespace
}  // namespace vdbfuse
