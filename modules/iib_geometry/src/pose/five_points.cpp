// SPDX-License-Identifier: Apache-2.0
#include "five_points.hpp"

#include <algorithm>
#include <cmath>

namespace cv::iib {
namespace {

const double SINGULAR = 1e-12;  // smaller pivots count as 0; all entries are of the order of 1

// Polynomials in x, y, z: Linear x y z 1; Quadratic xx xy xz x yy yz y zz z 1; Cubic in the order of Nister's
// section 3.2: xxx yyy xxy xyy xxz xx yyz yy xyz xy xzz xz x yzz yz y zzz zz z 1.
typedef Vec<double, 4> Linear;
typedef Vec<double, 10> Quadratic;
typedef Vec<double, 20> Cubic;

const int QUADRATIC[4][4] = {{0, 1, 2, 3}, {1, 4, 5, 6}, {2, 5, 7, 8}, {3, 6, 8, 9}};
const int CUBIC[10][4] = {{0, 2, 4, 5}, {2, 3, 8, 9}, {4, 8, 10, 11}, {5, 9, 11, 12}, {3, 1, 6, 7},
        {8, 6, 13, 14}, {9, 7, 14, 15}, {10, 13, 16, 17}, {11, 14, 17, 18}, {12, 15, 18, 19}};

void addProduct(const Linear& a, const Linear& b, double factor, Quadratic& sum)
{
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            sum[QUADRATIC[i][j]] += factor * a[i] * b[j];
}

void addProduct(const Quadratic& a, const Linear& b, double* sum)
{
    for (int i = 0; i < 10; i++)
        for (int j = 0; j < 4; j++)
            sum[CUBIC[i][j]] += a[i] * b[j];
}

/** Gauss-Jordan elimination of the first ROWS columns to the identity. False if the matrix is singular.
@param candidates number of columns to search for pivots. 0: columns keep their order, and their used entries are not cleared.
@param needed with 0 candidates: rows before this one are not eliminated completely.
@param column receives the order of the columns. */
template <int ROWS, int COLUMNS>
bool eliminate(Matx<double, ROWS, COLUMNS>& m, int candidates, int needed, int (&column)[COLUMNS])
{
    for (int c = 0; c < COLUMNS; c++)
        column[c] = c;
    for (int k = 0; k < ROWS; k++)
    {
        int row = k, at = k;
        for (int r = k; r < ROWS; r++)
            for (int c = k; c < std::max(candidates, k + 1); c++)
                if (std::abs(m(r, column[c])) > std::abs(m(row, column[at])))
                    row = r, at = c;
        std::swap(column[k], column[at]);
        const double pivot = m(row, column[k]);
        if (!(std::abs(pivot) > SINGULAR))
            return false;
        const int first = candidates ? 0 : k;
        for (int c = first; c < COLUMNS; c++)
        {
            std::swap(m(row, c), m(k, c));
            m(k, c) /= pivot;
        }
        for (int r = 0; r < ROWS; r++)
        {
            const double factor = m(r, column[k]);
            if (r == k || (r < k && r < needed) || factor == 0)
                continue;
            for (int c = first; c < COLUMNS; c++)
                m(r, c) -= factor * m(k, c);
        }
    }
    return true;
}

//! The entries of E as polynomials: E = xX + yY + zZ + W is in the null space of the five epipolar constraints.
bool nullSpace(const Point2d first[5], const Point2d second[5], Linear (&E)[9])
{
    Matx<double, 5, 9> m;
    for (int i = 0; i < 5; i++)
    {
        const Vec3d u(first[i].x, first[i].y, 1), v(second[i].x, second[i].y, 1);
        for (int k = 0; k < 9; k++)
            m(i, k) = v[k / 3] * u[k % 3] / norm(u) / norm(v);
    }
    int column[9];
    if (!eliminate(m, 9, 0, column))
        return false;
    for (int k = 0; k < 9; k++)
        for (int free = 0; free < 4; free++)
            E[column[k]][free] = k < 5 ? -m(k, column[5 + free]) : k == 5 + free;
    return true;
}

//! det E = 0 and E E' E - trace(E E') E / 2 = 0, ten cubic polynomials (equations 2 and 3).
Matx<double, 10, 20> constraints(const Linear (&E)[9])
{
    Matx<double, 10, 20> m = Matx<double, 10, 20>::zeros();
    for (int k = 0; k < 3; k++)
    {
        Quadratic minor = Quadratic::all(0);
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        addProduct(E[3 + a], E[6 + b], 1, minor);
        addProduct(E[3 + b], E[6 + a], -1, minor);
        addProduct(minor, E[k], m.val);
    }
    Quadratic square[3][3];  // E E' - trace(E E') / 2
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
        {
            square[r][c] = Quadratic::all(0);
            for (int k = 0; k < 3; k++)
                addProduct(E[3 * r + k], E[3 * c + k], 1, square[r][c]);
        }
    const Quadratic trace = square[0][0] + square[1][1] + square[2][2];
    for (int r = 0; r < 3; r++)
        square[r][r] -= trace * .5;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 3; k++)
                addProduct(square[r][k], E[3 * k + c], m.val + 20 * (1 + 3 * r + c));
    return m;
}

// Polynomials in z alone, the constant first.
template <int HIGHEST_OF_A, int HIGHEST_OF_B>
void addProduct(const Vec<double, 11>& a, const Vec<double, 11>& b, double factor, Vec<double, 11>& sum)
{
    for (int i = 0; i <= HIGHEST_OF_A; i++)
        for (int j = 0; j <= HIGHEST_OF_B && i + j < 11; j++)
            sum[i + j] += factor * a[i] * b[j];
}

}  // namespace

void fivePointEssentials(const Point2d first[5], const Point2d second[5], std::vector<Matx33d>& essentials)
{
    essentials.clear();
    essentials.reserve(10);
    Linear E[9];
    if (!nullSpace(first, second, E))
        return;
    const int FIRST_NEEDED = 4;
    Matx<double, 10, 20> m = constraints(E);
    int column[20];
    if (!eliminate(m, 0, FIRST_NEEDED, column))
        return;

    // Rows 4 to 9 begin with xxz, xx, yyz, yy, xyz, xy. The differences of these three pairs are linear in x and y:
    // B (x, y, 1)' = 0, where B has polynomials in z (section 3.2.1).
    Vec<double, 11> B[3][3], determinant = Vec<double, 11>::all(0);
    const int from[] = {10, 13, 16}, terms[] = {3, 3, 4};
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
        {
            B[r][c] = Vec<double, 11>::all(0);
            for (int k = 0; k < terms[c]; k++)
            {
                B[r][c][terms[c] - 1 - k] += m(4 + 2 * r, from[c] + k);
                B[r][c][terms[c] - k] -= m(5 + 2 * r, from[c] + k);
            }
        }
    for (int k = 0; k < 3; k++)
    {
        Vec<double, 11> minor = Vec<double, 11>::all(0);
        addProduct<4, 4>(B[1][(k + 1) % 3], B[2][(k + 2) % 3], 1, minor);
        addProduct<4, 4>(B[1][(k + 2) % 3], B[2][(k + 1) % 3], -1, minor);
        addProduct<7, 4>(minor, B[0][k], 1, determinant);
    }

    double roots[10];
    const int count = realRoots(determinant.val, 10, roots);
    for (int i = 0; i < count; i++)
    {
        const double z = roots[i];
        Matx33d at;
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++)
                for (int k = 4; k >= 0; k--)
                    at(r, c) = at(r, c) * z + B[r][c][k];
        // (x, y, 1) is orthogonal to all rows; the longest cross product of two rows is the most accurate
        Vec3d solution;
        for (int r = 0; r < 3; r++)
        {
            const Matx13d one = at.row(r), other = at.row((r + 1) % 3);
            const Vec3d product = Vec3d(one.val).cross(Vec3d(other.val));
            if (product.dot(product) > solution.dot(solution))
                solution = product;
        }
        if (solution[2] == 0)
            continue;
        const Linear xyz1(solution[0] / solution[2], solution[1] / solution[2], z, 1);
        Matx33d essential;
        for (int k = 0; k < 9; k++)
            essential.val[k] = E[k].dot(xyz1);
        essentials.push_back(essential * (1 / norm(essential)));
    }
}

}  // namespace cv::iib
