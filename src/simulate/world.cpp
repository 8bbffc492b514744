#include "simulate/world.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulate/look.h"

namespace bole::simulate {
namespace {

constexpr float kTurn = 6.2831853F;
constexpr float kLane = 0.75F;  // metres to either side of the drive that stay clear
// Streams of numbers: an addition draws from its own, so that the rest of a seed's world stays.
constexpr std::uint32_t kWorldStream = 2, kStandStream = 3, kTreeStream = 4;
constexpr float kCrookedLean = 0.12F, kStraightLean = 0.025F;  // standard deviations
constexpr float kCrookedBend = 0.1F, kStraightBend = 0.02F;

float draw(Random& random, Span span) { return random.uniform(span.low, span.high); }

// Puts things into the world, one kind after the other, each from its own stream of numbers.
class Gardener {
 public:
  Gardener(const SimOptions& options, std::uint64_t seed, const std::vector<Pose>& drive)
      : options_(options), seed_(seed), random_(seed, kWorldStream), drive_(drive) {
    for (const Pose& pose : drive) {
      x0_ = std::min(x0_, static_cast<float>(pose.x) - kReach);
      x1_ = std::max(x1_, static_cast<float>(pose.x) + kReach);
      y0_ = std::min(y0_, static_cast<float>(pose.y) - kReach);
      y1_ = std::max(y1_, static_cast<float>(pose.y) + kReach);
    }
  }

  World grow() {
    const bool treeless = options_.trees_per_ha.high <= 0;
    world_.seed = random_.bits();
    Random stand(world_.seed, kStandStream);
    crooked_ = draw(stand, options_.crooked_share);
    world_.look = draw_look(options_, random_, treeless);
    const float room = kReach;  // distant ground beyond the trees
    world_.terrain =
        Terrain(x0_ - room, y0_ - room, x1_ + room, y1_ + room, draw(random_, options_.slope),
                random_.uniform(0, kTurn), draw(random_, options_.undulation), random_.bits());
    if (!treeless) plant_trees();
    world_.trees = static_cast<int>(world_.columns.size());
    grow_bushes();
    scatter_clutter();
    raise_walls();
    return std::move(world_);
  }

 private:
  float hectares() const { return (x1_ - x0_) * (y1_ - y0_) * 1e-4F; }
  float ground(float x, float y) const { return world_.terrain.height(x, y); }

  // Metres from the nearest place of the drive.
  float from_drive(float x, float y) const {
    float nearest = std::numeric_limits<float>::max();
    for (const Pose& pose : drive_) {
      const float dx = x - static_cast<float>(pose.x), dy = y - static_cast<float>(pose.y);
      nearest = std::min(nearest, dx * dx + dy * dy);
    }
    return std::sqrt(nearest);
  }

  // A place whose distance from the drive is at least kLane + `radius`, and within reach of it.
  bool find_place(float radius, float& x, float& y) {
    for (int attempt = 0; attempt < 20; ++attempt) {
      x = random_.uniform(x0_, x1_);
      y = random_.uniform(y0_, y1_);
      const float distance = from_drive(x, y);
      if (distance > kLane + radius && distance < kReach) return true;
    }
    return false;
  }

  // One tree at most in each cell of a grid, somewhere in the cell; closer in some parts than in
  // others.
  void plant_trees() {
    // Evenly over the logarithm: open and dense woods alike.
    const float per_ha =
        options_.trees_per_ha.low *
        std::pow(options_.trees_per_ha.high / options_.trees_per_ha.low, random_.uniform(0, 1));
    const float bright = draw(random_, options_.bright_share);
    const float cover = draw(random_, options_.foot_cover);
    const float thickest = random_.uniform(
        mix(options_.diameter.low, options_.diameter.high, 0.35F), options_.diameter.high);
    const float cell = 100 / std::sqrt(per_ha * 1.6F);
    const std::uint32_t clumps = random_.bits();
    const int rows = static_cast<int>((y1_ - y0_) / cell) + 1;
    const int columns = static_cast<int>((x1_ - x0_) / cell) + 1;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const float x = x0_ + cell * static_cast<float>(column);
        const float y = y0_ + cell * static_cast<float>(row);
        const float density = 0.625F * (1 + 0.6F * noise(x / 9, y / 9, clumps));
        const float at_x = x + cell * random_.uniform(0, 1);
        const float at_y = y + cell * random_.uniform(0, 1);
        const Column tree = grow_tree(at_x, at_y, thickest, random_.chance(bright));
        const float distance = from_drive(at_x, at_y);
        if (!random_.chance(density) || distance > kReach || distance < kLane + tree.radius)
          continue;
        world_.columns.push_back(tree);
        if (random_.chance(cover)) cover_foot(tree);
        if (random_.chance(0.5F * cover)) spread_roots(tree);
        if (random_.chance(0.1F)) hang_branch(tree);
        if (tree.height > 6) add_crown(tree);
      }
    }
  }

  Column grow_tree(float x, float y, float thickest, bool bright) {
    Column tree;
    tree.x = x;
    tree.y = y;
    tree.z = ground(x, y);
    const float u = random_.uniform(0, 1);
    tree.radius = 0.5F * mix(options_.diameter.low, thickest, u * (0.4F + 0.6F * u));
    tree.taper = random_.uniform(0.004F, 0.03F);
    const bool crooked = random_.chance(crooked_);
    const float lean = crooked ? kCrookedLean : kStraightLean;
    tree.lean_x = lean * random_.normal();
    tree.lean_y = lean * random_.normal();
    tree.height = random_.chance(0.06F) ? random_.uniform(1.5F, 5) : random_.uniform(9, 28);
    tree.taper = std::min(tree.taper, 0.8F / tree.height);
    tree.flare = random_.uniform(0.05F, 0.5F);
    tree.flare_height = random_.uniform(0.12F, 0.3F) * (0.5F + tree.radius * 2);
    tree.bark = draw_bark(random_, bright);
    tree.seed = random_.bits();
    tree.bright = bright;
    tree.tree = static_cast<int>(world_.columns.size());
    weather(tree, crooked);
    return tree;
  }

  // What years of light, snow and litter made of it. A trunk that leans grows back upright, more or
  // less.
  static void weather(Column& tree, bool crooked) {
    Random random(tree.seed, kTreeStream);
    const float bend = crooked ? kCrookedBend : kStraightBend;
    const float righted = random.uniform(0, 0.8F);
    tree.bent = random.uniform(1, 6);
    tree.bow_x = (bend * random.normal() - righted * tree.lean_x) / (2 * tree.bent);
    tree.bow_y = (bend * random.normal() - righted * tree.lean_y) / (2 * tree.bent);
    if (random.chance(0.25F)) tree.flare = random.uniform(0.5F, 1.2F);
    tree.shade = random.uniform(0, 0.5F);
    if (random.chance(0.3F)) tree.heap = random.uniform(0, 0.06F);
  }

  void cover_foot(const Column& tree) {
    const int tufts = 2 + static_cast<int>(random_.bits() % 5);
    const bool green = random_.chance(0.6F);
    const float height = random_.uniform(0.05F, random_.chance(0.2F) ? 0.6F : 0.3F);
    for (int i = 0; i < tufts; ++i) {
      const float bearing = random_.uniform(0, kTurn);
      const float from = tree.radius * random_.uniform(1, 1.8F) + random_.uniform(0, 0.25F);
      add_tuft(tree.x + from * std::cos(bearing), tree.y + from * std::sin(bearing),
               height * random_.uniform(0.5F, 1.2F), green);
    }
  }

  // Roots run from the trunk into the ground.
  void spread_roots(const Column& tree) {
    const int roots = 2 + static_cast<int>(random_.bits() % 4);
    for (int i = 0; i < roots; ++i) {
      const float bearing = random_.uniform(0, kTurn);
      const float dx = tree.radius * std::cos(bearing), dy = tree.radius * std::sin(bearing);
      const float start = 0.7F, end = random_.uniform(1.6F, 3.5F);
      const float radius = tree.radius * random_.uniform(0.15F, 0.35F);
      const float ax = tree.x + start * dx, ay = tree.y + start * dy;
      const float bx = tree.x + end * dx, by = tree.y + end * dy;
      world_.logs.push_back({ax, ay, ground(ax, ay) + tree.radius * random_.uniform(0.2F, 0.6F), bx,
                             by, ground(bx, by) - 0.7F * radius, radius, tree.bark,
                             random_.bits()});
    }
  }

  void add_tuft(float x, float y, float height, bool green) {
    Leaves tuft;
    tuft.x = x;
    tuft.y = y;
    tuft.z = ground(x, y) - 0.02F;
    tuft.half_width = height * random_.uniform(0.6F, 2) + 0.05F;
    tuft.height = height;
    tuft.leaf = random_.uniform(0.006F, 0.03F);
    tuft.density = random_.uniform(0.5F, 0.95F);
    tuft.colour = green ? draw_green(random_) : draw_dull(random_);
    tuft.blades = true;
    tuft.seed = random_.bits();
    world_.leaves.push_back(tuft);
  }

  void add_crown(const Column& tree) {
    const float depth =
        0.5F * std::min(tree.height * random_.uniform(0.25F, 0.6F), tree.height - 4.5F);
    const float h = tree.height - depth;
    add_bush(tree.axis_x(h), tree.axis_y(h), tree.z + h,
             random_.uniform(0.5F, 1.3F) + 4 * tree.radius);
    Leaves& crown = world_.leaves.back();
    crown.height = 1.15F * depth;
    crown.leaf = random_.uniform(0.08F, 0.25F);
    crown.colour = crown.colour * 0.7F;
  }

  void hang_branch(const Column& tree) {
    const float bearing = random_.uniform(0, kTurn);
    const float from = tree.radius + random_.uniform(0.2F, 1.2F);
    add_bush(tree.x + from * std::cos(bearing), tree.y + from * std::sin(bearing),
             tree.z + random_.uniform(1, 4.5F), random_.uniform(0.3F, 1));
  }

  void add_bush(float x, float y, float z, float half_width) {
    Leaves bush;
    bush.x = x;
    bush.y = y;
    bush.z = z;
    bush.half_width = half_width;
    bush.height = half_width * random_.uniform(0.5F, 1.4F);
    bush.leaf = random_.uniform(0.025F, 0.12F);
    bush.density = random_.uniform(0.25F, 0.85F);
    bush.colour = draw_green(random_);
    bush.seed = random_.bits();
    world_.leaves.push_back(bush);
  }

  void grow_bushes() {
    const int bushes = static_cast<int>(draw(random_, options_.bushes_per_ha) * hectares());
    for (int i = 0; i < bushes; ++i) {
      const float size = random_.uniform(0.15F, random_.chance(0.2F) ? 2 : 0.8F);
      float x = 0, y = 0;
      if (!find_place(size, x, y)) continue;
      add_bush(x, y, ground(x, y) + size * random_.uniform(0.3F, 0.9F), size);
    }
    const int tufts = static_cast<int>(static_cast<float>(bushes) * random_.uniform(0.5F, 4));
    for (int i = 0; i < tufts; ++i) {
      float x = 0, y = 0;
      if (find_place(0, x, y)) add_tuft(x, y, random_.uniform(0.05F, 0.5F), random_.chance(0.6F));
    }
  }

  void scatter_clutter() {
    const int things = static_cast<int>(draw(random_, options_.clutter_per_ha) * hectares());
    for (int i = 0; i < things; ++i) {
      const float size = random_.uniform(0.1F, random_.chance(0.15F) ? 1.5F : 0.5F);
      float x = 0, y = 0;
      if (!find_place(size, x, y)) continue;
      const float kind = random_.uniform(0, 1);
      if (kind < 0.45F) {
        add_rock(x, y, size);
      } else if (kind < 0.6F) {
        add_stump(x, y);
      } else if (kind < 0.75F) {
        add_log(x, y);
      } else if (kind < 0.9F) {
        add_post(x, y);
      } else {
        add_person(x, y);
      }
    }
  }

  void add_rock(float x, float y, float size) {
    const float half_height = size * random_.uniform(0.4F, 1.1F);
    world_.boulders.push_back({x, y, ground(x, y) + half_height * random_.uniform(-0.3F, 0.5F),
                               size, half_height, draw_dull(random_), random_.uniform(0.3F, 1),
                               random_.bits()});
  }

  void add_stump(float x, float y) {
    Column stump = grow_tree(x, y, options_.diameter.high, random_.chance(0.3F));
    stump.height = random_.uniform(0.15F, 0.8F);
    stump.tree = -1;
    world_.columns.push_back(stump);
  }

  void add_log(float x, float y) {
    const float bearing = random_.uniform(0, kTurn), half = random_.uniform(0.8F, 5);
    const float dx = half * std::cos(bearing), dy = half * std::sin(bearing);
    if (from_drive(x + dx, y + dy) < kLane + 0.4F || from_drive(x - dx, y - dy) < kLane + 0.4F ||
        from_drive(x, y) < kLane + half) {
      return;
    }
    const float radius = random_.uniform(0.05F, 0.3F);
    world_.logs.push_back({x - dx, y - dy, ground(x - dx, y - dy) + radius * 0.8F, x + dx, y + dy,
                           ground(x + dx, y + dy) + radius * 0.8F, radius,
                           draw_bark(random_, random_.chance(0.3F)), random_.bits()});
  }

  Column upright(float x, float y, float z, float radius, float height, Colour colour) {
    Column post;
    post.x = x;
    post.y = y;
    post.z = z;
    post.radius = radius;
    post.taper = 0;
    post.height = height;
    post.flare = 0;
    post.bark = {colour * 0.7F, colour, random_.uniform(5, 30), 8, random_.uniform(0, 0.6F), 0,
                 false};
    post.seed = random_.bits();
    return post;
  }

  void add_post(float x, float y) {
    world_.columns.push_back(
        upright(x, y, ground(x, y), random_.uniform(0.03F, 0.1F), random_.uniform(0.6F, 2.2F),
                random_.chance(0.5F) ? draw_vivid(random_) : draw_dull(random_)));
  }

  void add_person(float x, float y) {
    const float z = ground(x, y), tall = random_.uniform(1.5F, 1.95F);
    const float bearing = random_.uniform(0, kTurn), apart = random_.uniform(0.08F, 0.3F);
    const float dx = apart * std::cos(bearing), dy = apart * std::sin(bearing);
    const Colour trousers = draw_vivid(random_);
    world_.columns.push_back(upright(x - dx, y - dy, z, 0.085F, 0.5F * tall, trousers));
    world_.columns.push_back(upright(x + dx, y + dy, z, 0.085F, 0.5F * tall, trousers));
    world_.boulders.push_back(
        {x, y, z + 0.65F * tall, 0.25F, 0.22F * tall, draw_vivid(random_), 0.2F, random_.bits()});
    world_.boulders.push_back({x, y, z + 0.92F * tall, 0.1F, 0.13F,
                               Colour{0.5F, 0.35F, 0.28F} * random_.uniform(0.3F, 1.2F), 0.1F,
                               random_.bits()});
  }

  void raise_walls() {
    const int walls = static_cast<int>(std::lround(draw(random_, options_.walls)));
    for (int i = 0; i < walls; ++i) {
      Wall wall;
      float x = 0, y = 0;
      const float half = random_.uniform(2, 12), bearing = random_.uniform(0, kTurn);
      if (!find_place(half, x, y)) continue;
      wall.ax = x - half * std::cos(bearing);
      wall.ay = y - half * std::sin(bearing);
      wall.bx = x + half * std::cos(bearing);
      wall.by = y + half * std::sin(bearing);
      wall.kind = static_cast<Wall::Kind>(random_.bits() % 3);
      const float low =
          std::min({ground(wall.ax, wall.ay), ground(wall.bx, wall.by), ground(x, y)});
      wall.z = low - 0.3F;
      wall.height = 0.3F + (wall.kind == Wall::Kind::cliff ? random_.uniform(2, 8)
                                                           : random_.uniform(0.7F, 3));
      wall.colour = wall.kind == Wall::Kind::hedge ? draw_green(random_) : draw_dull(random_);
      wall.seed = random_.bits();
      world_.walls.push_back(wall);
    }
  }

  const SimOptions& options_;
  std::uint64_t seed_;
  Random random_;
  const std::vector<Pose>& drive_;
  World world_;
  float crooked_ = 0;  // share of the trunks
  float x0_ = std::numeric_limits<float>::max(), y0_ = x0_;
  float x1_ = std::numeric_limits<float>::lowest(), y1_ = x1_;
};

}  // namespace

std::array<Point, 4> Column::axis_hull() const {
  const float tangents_meet = 0.5F * bent;
  return {{{x, y},
           {x + lean_x * tangents_meet, y + lean_y * tangents_meet},
           {axis_x(bent), axis_y(bent)},
           {axis_x(height), axis_y(height)}}};
}

World grow_world(const SimOptions& options, std::uint64_t seed, const std::vector<Pose>& drive) {
  return Gardener(options, seed, drive).grow();
}

}  // namespace bole::simulate
