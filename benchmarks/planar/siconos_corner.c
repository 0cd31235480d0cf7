/* A corner of one body and a face of another one as a relation of Siconos: h gives
 * y = (gap, way along the face) [m], G its gradient (2, n) by q, column by column.
 *
 * q: (x, z, angle) of the corner's body, then of the face's, without the one that is fixed.
 * shape: corner; start, direction and length of the face, in the frames of their bodies, of a
 * fixed one in the plane's [m]; whether the corner's body moves, 1 or 0; the same of the face's. */
#include <math.h>

/* No corner acts that is beside the face, or so deep below it [m]: its gap is out of reach [m].
 * What is so close to the end of a face is on it [m]. */
static const double DEEP = 0.05, FAR = 1.0, END = 1e-9;

/* In the plane: ways to the corner from its body's centre of mass and from that of the face's
 * body, direction of the face. */
struct seen {
  double arm[2], from[2], along[2], gap, way;
};

static struct seen look(const double *q, const double *shape) {
  struct seen a;
  const double fixed[3] = {0.0, 0.0, 0.0};
  const double *b = shape[7] ? q : fixed, *f = shape[8] ? (shape[7] ? q + 3 : q) : fixed;
  const double cb = cos(b[2]), sb = sin(b[2]), cf = cos(f[2]), sf = sin(f[2]);
  a.arm[0] = cb * shape[0] - sb * shape[1];
  a.arm[1] = sb * shape[0] + cb * shape[1];
  a.along[0] = cf * shape[4] - sf * shape[5];
  a.along[1] = sf * shape[4] + cf * shape[5];
  for (int i = 0; i < 2; ++i) a.from[i] = b[i] + a.arm[i] - f[i];
  const double x = a.from[0] - (cf * shape[2] - sf * shape[3]);
  const double z = a.from[1] - (sf * shape[2] + cf * shape[3]);
  a.way = x * a.along[0] + z * a.along[1];
  a.gap = x * a.along[1] - z * a.along[0];
  if (a.way < -END || a.way > shape[6] + END || a.gap < -DEEP) a.gap = FAR;
  return a;
}

static void gap(const double *q, const double *shape, double *y) {
  const struct seen a = look(q, shape);
  y[0] = a.gap;
  y[1] = a.way;
}

static void gradient(unsigned n, const double *q, const double *shape, double *G) {
  const struct seen a = look(q, shape);
  for (int i = 0; i < 2; ++i) {
    const double x = i ? a.along[0] : a.along[1], z = i ? a.along[1] : -a.along[0];
    const double corner = a.arm[0] * z - a.arm[1] * x, face = a.from[1] * x - a.from[0] * z;
    const double row[6] = {x, z, corner, -x, -z, face};
    for (unsigned j = 0; j < n; ++j) G[2 * j + i] = row[j + (shape[7] ? 0 : 3)];
  }
}

/* Functions h0, G0, h1, G1 and so on, one pair a corner: CORNER(number, shape). */
#define CORNER(k, ...)                                                             \
  static const double shape##k[] = {__VA_ARGS__};                                  \
  void h##k(unsigned n, double *q, unsigned m, double *y, unsigned l, double *z) { \
    gap(q, shape##k, y);                                                           \
  }                                                                                \
  void G##k(unsigned n, double *q, unsigned m, double *G, unsigned l, double *z) { \
    gradient(n, q, shape##k, G);                                                   \
  }
