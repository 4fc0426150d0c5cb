#include <gtest/gtest.h>

#include "base/error.hpp"
#include "deck/description.hpp"

namespace mortise::deck {
namespace {

struct Wheel {
  double radius = 1;
  std::string tyre = "road";
};

struct Cart {
  std::string title;
  int seats = 2;
  bool roof = false;
  std::array<double, 3> size{1, 1, 1};
  std::optional<double> price;
  std::map<std::string, Wheel> wheels;
  std::vector<Wheel> spares;
};

void describe(Description<Wheel>& d)
{
  d.help("A wheel.");
  d.key("radius", &Wheel::radius, "Radius.").required().positive();
  d.key("tyre", &Wheel::tyre, "Kind.").one_of({"road", "mud"});
}

void describe(Description<Cart>& d)
{
  d.help("A cart.");
  d.key("title", &Cart::title, "Name.");
  d.key("seats", &Cart::seats, "Number.").at_least(1);
  d.key("roof", &Cart::roof, "Covered?");
  d.key("size", &Cart::size, "Edges.").positive();
  d.key("price", &Cart::price, "Money.").below(100);
  d.key("wheels", &Cart::wheels, "By place.").required();
  d.key("spares", &Cart::spares, "More.");
  d.check([](const Cart& cart, const std::string& path, Document& document) {
    if (cart.wheels.size() == 1) document.error(join(path, "wheels"), "one wheel is a unicycle");
  });
}

// The whole text of what is wrong with a deck; "" if nothing is.
std::string complaints(const std::string& text, const std::vector<std::string>& settings = {})
{
  try {
    Document document(text, "cart.yaml", settings);
    Cart cart;
    read(cart, document);
    document.check();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), ExitStatus::bad_input);
    return error.what();
  }
  return "";
}

const std::string good = "wheels:\n  left: {radius: 0.5}\n  right: {radius: 5e-1, tyre: mud}\n";

TEST(Deck, ReadsEveryKindOfValue)
{
  Document document(good + "title: Old cart\nseats: 4\nroof: true\nsize: [1, 2.5]\nprice: 99.5\nspares:\n  - {radius: 2}\n",
                    "cart.yaml", {"seats=5", "wheels.left.radius=3", "spares[0].tyre=mud"});
  Cart cart;
  read(cart, document);
  document.check();
  EXPECT_EQ(cart.title, "Old cart");
  EXPECT_EQ(cart.seats, 5);
  EXPECT_TRUE(cart.roof);
  EXPECT_EQ(cart.size, (std::array<double, 3>{1, 2.5, 0}));
  EXPECT_EQ(cart.price, 99.5);
  EXPECT_EQ(cart.wheels.at("left").radius, 3);
  EXPECT_EQ(cart.wheels.at("right").tyre, "mud");
  EXPECT_EQ(cart.spares.at(0).tyre, "mud");
}

struct Mistake {
  std::string text, message;
};

class Mistakes : public testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, AreReportedWithPlaceAndCure)
{
  EXPECT_EQ(complaints(GetParam().text), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    All, Mistakes,
    testing::Values(
        Mistake{good + "seats: abc\n", "cart.yaml:4: seats: expected a whole number >= 1, found \"abc\""},
        Mistake{good + "seats: 1.5\n", "cart.yaml:4: seats: expected a whole number >= 1, found \"1.5\""},
        Mistake{good + "seats: 0\n", "cart.yaml:4: seats: expected a whole number >= 1, found \"0\""},
        Mistake{good + "price: .nan\n", "cart.yaml:4: price: expected a number < 100, found \".nan\""},
        Mistake{good + "price: [1]\n", "cart.yaml:4: price: expected a number < 100, found a list"},
        Mistake{good + "roof: maybe\n", "cart.yaml:4: roof: expected true or false, found \"maybe\""},
        Mistake{good + "size: [1]\n", "cart.yaml:4: size: expected a list of 2 (plane models) or 3 entries, found 1 entries"},
        Mistake{good + "seat: 3\n",
                "cart.yaml:4: seat: unknown key, did you mean \"seats\"? (there are title, seats, roof, size, price, wheels, "
                "spares)"},
        Mistake{good + "seats: 3\nseats: 4\n", "cart.yaml:5: seats: is given twice"},
        Mistake{"wheels:\n  left: {tyre: roads, radius: 1}\n  right: {radius: 1}\n",
                "cart.yaml:2: wheels.left.tyre: unknown value \"roads\", did you mean \"road\"? (there are road, mud)"},
        Mistake{"wheels:\n  left: {tyre: mud}\n  right: {radius: 1}\n",
                "cart.yaml:2: wheels.left: the key \"radius\" is missing: Radius."},
        Mistake{"title: x\n", "cart.yaml:1: the key \"wheels\" is missing: By place."},
        Mistake{"wheels: {only: {radius: 1}}\n", "cart.yaml:1: wheels: one wheel is a unicycle"},
        Mistake{"", "cart.yaml:1: the deck is empty"}, Mistake{"# only a comment\n", "cart.yaml:1: the deck is empty"},
        Mistake{good + "---\ntitle: two\n",
                "cart.yaml:5: a second document begins, after `---`; a deck is one document, give each its own file"},
        Mistake{"[],", "cart.yaml:1: something stands behind the end of the deck; look for a comma or a bracket too many"},
        Mistake{good + "title: K\xe4"
                       "fig\n",
                "cart.yaml:4: this line is not UTF-8; save the deck in that encoding"},
        Mistake{"- a\n- b\n", "cart.yaml:1: a deck is a mapping of sections such as `mesh:` and `bodies:`"}));

TEST(Deck, SyntaxErrorsHaveALine)
{
  EXPECT_EQ(complaints("title: x\nwheels: {left: [1, 2}\n").rfind("cart.yaml:2: this is not valid YAML", 0), 0U);
}

TEST(Deck, WhatIsNoYamlIsToldWithACure)
{
  EXPECT_EQ(complaints("title: x\nwheels:\n \tleft: {radius: 1}\n"),
            "cart.yaml:3: a tab indents this line; YAML takes spaces alone");
  EXPECT_NE(complaints("title: a: b\n").find("takes quotes"), std::string::npos);
  EXPECT_NE(complaints("wheels:\n  left: {radius: 1}\n right: {radius: 1}\n").find("indented otherwise"), std::string::npos);
  const auto in_list = complaints("spares:\n  - radius: 1\n   tyre: road\n");
  EXPECT_NE(in_list.find("indented otherwise"), std::string::npos) << in_list;
  EXPECT_EQ(in_list.find("bracket"), std::string::npos) << in_list;
  EXPECT_NE(complaints("spares:\n  - {radius: 1\n").find("bracket or brace that is not closed"), std::string::npos);
  EXPECT_NE(complaints("wheels: {left: {radius:1}}\n").find("a space is missing after \"radius:\""), std::string::npos);
}

TEST(Deck, AllMistakesAreReportedAtOnceInTheOrderOfLines)
{
  const auto text = complaints("seats: none\nwheels:\n  left: {radius: -1}\n  right: {radius: 1}\nroof: 7\n");
  EXPECT_EQ(text,
            "cart.yaml:1: seats: expected a whole number >= 1, found \"none\"\n"
            "cart.yaml:3: wheels.left.radius: expected a number > 0, found \"-1\"\n"
            "cart.yaml:5: roof: expected true or false, found \"7\"");
}

TEST(Deck, SettingsSayThatTheyAreToBlame)
{
  EXPECT_EQ(complaints(good, {"seats=none"}), "--set seats=none: seats: expected a whole number >= 1, found \"none\"");
  EXPECT_EQ(complaints(good, {"wheels.left.radius=-2"}),
            "--set wheels.left.radius=-2: wheels.left.radius: expected a number > 0, found \"-2\"");
  EXPECT_EQ(complaints(good, {"seats"}), "--set seats: expected key.path=value");
  EXPECT_EQ(complaints(good + "spares: [{radius: 1}]\n", {"spares[1].radius=2"}),
            "--set spares[1].radius=2: spares has no entry [1], only 1");
  EXPECT_EQ(complaints(good + "spares: [{radius: 1}]\n", {"spares.0.radius=-2"}),
            "--set spares.0.radius=-2: spares[0].radius: expected a number > 0, found \"-2\"");
  const std::string without = std::string(good).substr(0, std::string(good).find("spares"));
  EXPECT_EQ(complaints(without, {"spares.0.radius=2"}), "--set spares.0.radius=2: spares: expected a list, found a mapping");
  EXPECT_EQ(complaints(good, {"seats", "title.a.b=1", "price=[", "seats=3"}),
            "--set seats: expected key.path=value\n--set price=[: the value is not valid YAML: end of sequence flow not found");
}

TEST(Deck, WhatIsWrittenReadsBackTheSame)
{
  Document document(good + "size: [1, 2, 3]\nprice: 0.1\nspares: [{radius: 1e-17}]\n", "cart.yaml", {});
  Cart cart;
  read(cart, document);
  document.check();
  const auto text = YAML::Dump(Codec<Cart>::write(cart));
  EXPECT_NE(text.find("seats: 2"), std::string::npos);  // a default
  Document again(text, "again.yaml", {});
  Cart copy;
  read(copy, again);
  again.check();
  EXPECT_EQ(copy.size, cart.size);
  EXPECT_EQ(copy.price, cart.price);
  EXPECT_EQ(copy.spares.at(0).radius, 1e-17);
  EXPECT_EQ(YAML::Dump(Codec<Cart>::write(copy)), text);
}

TEST(Deck, SchemaSaysTheSameAsTheReader)
{
  const auto json = schema<Cart>("urn:cart");
  EXPECT_EQ(json["properties"]["seats"]["minimum"], 1);
  EXPECT_EQ(json["properties"]["wheels"]["additionalProperties"]["properties"]["tyre"]["enum"], nlohmann::json({"road", "mud"}));
  EXPECT_EQ(json["required"], nlohmann::json({"wheels"}));
  EXPECT_EQ(json["additionalProperties"], false);
}

TEST(Names, NearestByEditDistance)
{
  EXPECT_EQ(nearest("grond", {"ground", "round", "top"}), "ground");
  EXPECT_EQ(nearest("xyzzy", {"ground", "top"}), "");
}

}  // namespace
}  // namespace mortise::deck
