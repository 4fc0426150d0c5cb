// A ribbon that turns through itself: closed, and no border of a body.
x[] = {0, 4, 4, 1, 1, 2, 2, 0};
y[] = {0, 0, 3, 3, -1, -1, 1, 1};
For k In {0:7}
  Point(k + 1) = {x[k], y[k], 0, 0.3};
EndFor
For k In {1:7}
  Line(k) = {k, k + 1};
EndFor
Line(8) = {8, 1};
Physical Curve("ribbon") = {1:8};
