// Sectors of 120 degrees of a shaft of two lobes a sector, r = 1 + 0.05 cos(6 theta + phase), and a hub whose bore is its offset 0.003 along the radius;
// seven faces and five a sector. Of all three sectors each body is one.
DefineConstant[ sectors = 1, phase = 0, overlap = 0.003 ];
SetFactory("Built-in");
thick = 0.3; points = 40; third = 2 * Pi / 3; e = 0.05;
Macro LobedRing
  // Straight from the inner curve to the outer one at each cut; both are splines through points of the curve, so many that nodes lie on it.
  For s In {0:sectors - 1}
    For side In {0:1}
      For i In {0:points}
        t = third * (s + i / points);
        r = (side == lobed) ? 1 + e * Cos(6 * t + phase) + outward : plain;
        Point(p + 1000 * s + 100 * side + i) = {r * Cos(t), r * Sin(t), 0};
      EndFor
    EndFor
  EndFor
Return
