// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/model/texture_search.hpp>

#include <io/model_test_support.hpp>

#include <gmock/gmock.h>

namespace glidar {
namespace {

using testing::TestFolder;
namespace fs = std::filesystem;

struct Spelling {
  const char* what;
  const char* file;  ///< that exists in the model's folder
  const char* name;  ///< as the model spells it
};

void PrintTo(const Spelling& spelling, std::ostream* out) {
  *out << spelling.what;
}

class TextureSpelling : public ::testing::TestWithParam<Spelling> {};

TEST_P(TextureSpelling, IsFound) {
  const TestFolder temp;
  const fs::path file = temp.write(GetParam().file, "x");
  const TextureLookup lookup = TextureSearch({temp.path(), temp.path(), {}}).find(GetParam().name);
  EXPECT_EQ(lookup.found, file.string());
  EXPECT_EQ(lookup.reason, "");
}

INSTANTIATE_TEST_SUITE_P(
    TextureSearch, TextureSpelling,
    ::testing::Values(Spelling{"AsGiven", "a.png", "a.png"},
                      Spelling{"InASubfolder", "images/a.png", "images/a.png"},
                      Spelling{"DotBackslash", "a.png", ".\\a.png"},
                      Spelling{"BackslashFolder", "images/a.png", ".\\images\\a.png"},
                      Spelling{"TrailingSpace", "a.png", "a.png "},
                      Spelling{"SpaceInside", "a b.png", "a b.png"},
                      Spelling{"PercentSpace", "a b.png", "a%20b.png"},
                      Spelling{"PercentInTheFilesName", "a%20b.png", "a%20b.png"},
                      Spelling{"AbsolutePath", "a.png", "/home/somebody/a.png"},
                      Spelling{"DriveLetter", "a.png", "C:\\art\\a.png"},
                      Spelling{"DriveLetterInTextures", "textures/a.png", "D:\\art\\a.png"},
                      Spelling{"FileUri", "a.png", "file:///home/a.png"},
                      Spelling{"FolderThatIsGone", "a.png", "images/a.png"},
                      Spelling{"ParentThatIsOutside", "a.png", "../other/a.png"},
                      Spelling{"TexturesFolder", "textures/a.png", "a.png"},
                      Spelling{"MaterialsTexturesFolder", "materials/textures/a.png", "a.png"},
                      Spelling{"OtherCase", "Wall.PNG", "wall.png"},
                      Spelling{"OtherCaseInTextures", "textures/Wall.PNG", "wall.png"},
                      Spelling{"UnknownMtlOption", "a.jpg", "sRGB -o 0.1 a.jpg"}),
    [](const auto& tested) { return std::string(tested.param.what); });

TEST(TextureSearch, TheExactCaseWinsOverAnother) {
  const TestFolder temp;
  temp.write("A.png", "x");
  const fs::path exact = temp.write("textures/a.png", "x");
  EXPECT_EQ(TextureSearch({temp.path(), temp.path(), {}}).find("a.png").found, exact.string());
}

TEST(TextureSearch, ListsEachFolderOnce) {
  const TestFolder temp;
  const ModelFolder folder{temp.path(), temp.path(), {}};
  TextureSearch search(folder);
  EXPECT_EQ(search.find("missing.png").found, "");
  const fs::path late = temp.write("A.PNG", "x");
  EXPECT_EQ(search.find("a.png").found, "");
  EXPECT_EQ(TextureSearch(folder).find("a.png").found, late.string());
}

TEST(TextureSearch, AModelPackageSharesItsMaterials) {
  const TestFolder temp;
  const fs::path file = temp.write("materials/textures/wood.png", "x");
  const fs::path model = temp.write("meshes/chair.dae", "x");
  const ModelFolder folder = model_folder(model);
  EXPECT_EQ(folder.root, temp.path());
  EXPECT_EQ(TextureSearch(folder).find("wood.png").found, file.string());
}

TEST(TextureSearch, ModelConfigMarksAPackage) {
  const TestFolder temp;
  temp.write("model.config", "x");
  const fs::path file = temp.write("textures/wood.png", "x");
  EXPECT_EQ(
      TextureSearch(model_folder(temp.write("dae/a.dae", "x"))).find("../textures/wood.png").found,
      file.string());
}

TEST(TextureSearch, ResolvesParentsOfLinksLikeTheSystem) {
  const TestFolder temp;
  temp.write("deep/inner/x", "x");
  temp.write("wood.png", "wrong");
  const fs::path file = temp.write("deep/wood.png", "right");
  fs::create_directory_symlink(temp.path() / "deep/inner", temp.path() / "link");
  const ModelFolder folder{temp.path(), temp.path(), {}};
  EXPECT_EQ(confine("link/../wood.png", folder).path, file);
  EXPECT_EQ(confine("gone/../wood.png", folder).path, temp.path() / "wood.png");
  EXPECT_EQ(confine("link/../../../secret.png", folder).access, Access::outside);
}

TEST(TextureSearch, LinksOutOfTheRootAreRejectedInParentPathsToo) {
  const TestFolder temp;
  temp.write("elsewhere/inner/x", "x");
  temp.write("elsewhere/secret.png", "x");
  const fs::path model = temp.write("model/a.obj", "x");
  fs::create_directory_symlink(temp.path() / "elsewhere/inner", temp.path() / "model/link");
  EXPECT_EQ(confine("link/../secret.png", model_folder(model)).access, Access::outside);
}

TEST(TextureSearch, NothingOutsideTheRootIsFound) {
  const TestFolder temp;
  temp.write("secret.png", "x");
  const fs::path model = temp.write("inner/a.obj", "x");
  const TextureLookup lookup = TextureSearch(model_folder(model)).find("../secret.png");
  EXPECT_EQ(lookup.found, "");
  EXPECT_THAT(lookup.reason, ::testing::StartsWith("outside the model's folder"));
}

TEST(TextureSearch, ALinkOutOfTheRootIsRejected) {
  const TestFolder temp;
  temp.write("secret.png", "x");
  const fs::path model = temp.write("inner/a.obj", "x");
  fs::create_symlink("../secret.png", temp.path() / "inner" / "link.png");
  EXPECT_EQ(TextureSearch(model_folder(model)).find("link.png").found, "");
  EXPECT_THAT(TextureSearch(model_folder(model)).find("link.png").reason,
              ::testing::StartsWith("outside the model's folder"));
}

/// A model's folder, and a texture folder beside it.
class TextureFolders : public ::testing::Test {
 protected:
  TextureFolders() { temp_.write("art/skins/images/a.png", "x"); }
  [[nodiscard]] TextureLookup find(const std::string& name) const {
    return TextureSearch(folder_).find(name);
  }

  TestFolder temp_;
  ModelFolder folder_ = model_folder(temp_.write("model/a.obj", "x"), {temp_ / "art/skins"});
};

TEST_F(TextureFolders, AreSearchedByTheLastComponentsOfTheName) {
  for (const char* name :
       {"../images/a.png", "../../x/images/a.png", "/home/somebody/images/a.png", "images\\a.png",
        "C:\\art\\images\\a.png", "model://NAME/images/a.png", "package://NAME/images/a.png",
        "file:///home/images/a.png", "..%2Fimages/a.png"}) {
    EXPECT_EQ(find(name).found, (temp_ / "art/skins/images/a.png").string()) << name;
  }
}

TEST_F(TextureFolders, MoreComponentsWinOverFewerAndTheModelsFolderOverAll) {
  temp_.write("art/skins/a.png", "x");
  EXPECT_EQ(find("../images/a.png").found, (temp_ / "art/skins/images/a.png").string());
  EXPECT_EQ(find("../other/a.png").found, (temp_ / "art/skins/a.png").string());
  temp_.write("model/a.png", "x");
  EXPECT_EQ(find("../images/a.png").found, (temp_ / "model/a.png").string());
}

TEST_F(TextureFolders, AreSearchedInTheirOrderIgnoringLetterCaseLast) {
  const fs::path second = temp_.write("more/B.PNG", "x");
  folder_.texture_folders.push_back(temp_ / "more");
  EXPECT_EQ(find("../b.png").found, second.string());
  const fs::path exact = temp_.write("art/skins/b.png", "x");
  EXPECT_EQ(find("../b.png").found, exact.string());
}

TEST_F(TextureFolders, NothingOutsideOfThemIsFound) {
  temp_.write("art/secret.png", "x");
  fs::create_symlink("../secret.png", temp_ / "art/skins/link.png");
  for (const char* name : {"../art/secret.png", "../link.png", "model://skins/../secret.png"}) {
    EXPECT_EQ(find(name).found, "") << name;
  }
  EXPECT_THAT(find("../art/secret.png").reason, ::testing::HasSubstr("--texture-folder"));
  EXPECT_THAT(find("model://NAME/b.png").reason, ::testing::HasSubstr("--texture-folder"));
}

TEST_F(TextureFolders, AreNamedAsTheRemedyForAbsoluteNames) {
  for (const char* name : {"/home/somebody/wood.png", "C:\\art\\wood.png", "d:/art/wood.png",
                           "\\\\server\\art\\wood.png", "file:///C:/art/wood.png"}) {
    EXPECT_EQ(
        find(name).reason,
        "not found; name a folder above it with --texture-folder, or copy it into the model's "
        "folder")
        << name;
  }
  EXPECT_EQ(find("wood.png").reason, "not found");
  EXPECT_NE(find("").reason, "");
}

TEST(TextureSearch, FoldersAndDevicesAreNotAcceptedAsTextures) {
  const TestFolder temp;
  fs::create_directory(temp.path() / "a.png");
  EXPECT_EQ(TextureSearch({temp.path(), temp.path(), {}}).find("a.png").reason, "not a file");
  EXPECT_EQ(TextureSearch({temp.path(), temp.path(), {}}).find("/dev/zero").found, "");
}

TEST(TextureSearch, InvalidNamesAreMissingWithAReason) {
  const TestFolder temp;
  const ModelFolder folder{temp.path(), temp.path(), {}};
  for (const std::string& name :
       {std::string(), std::string("   "), std::string("http://host/a.png"), std::string(5000, 'a'),
        std::string("a\0b.png", 7), std::string(300, 'b') + ".png"}) {
    const TextureLookup lookup = TextureSearch(folder).find(name);
    EXPECT_EQ(lookup.found, "") << name.substr(0, 20);
    EXPECT_NE(lookup.reason, "") << name.substr(0, 20);
  }
}

}  // namespace
}  // namespace glidar
