#pragma once

namespace bole {

/// The ground as a level plane `height` metres under the viewpoint. Tangents are of elevations,
/// negative below the horizon.

/// Horizontal distance, metres, to the ground seen at `tangent`; infinite at or above the horizon.
double ground_distance(double tangent, double height);

/// The tangent of the elevation at which ground at `distance` metres is seen.
double ground_tangent(double distance, double height);

/// A trunk is a cylinder whose nearest line stands at `foot_distance` from the camera's axis and
/// whose tangent lines span `angular_width` radians (less than pi). With s = sin(angular_width /
/// 2): diameter = 2 foot_distance s / (1 - s), and the axis stands at foot_distance + diameter / 2.
double diameter_from_foot(double foot_distance, double angular_width);

/// The angle between the tangent lines: sin(angular_width / 2) = diameter / (2 range), range to the
/// axis. pi when the viewpoint is inside the trunk.
double angular_width(double diameter, double range);

}  // namespace bole
