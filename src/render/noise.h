// Noise estimates of a render (docs/noise.md, docs/design/sampling.md).
#pragma once
#include "render/film.h"

namespace alpenglow::render {

/// Added to the mean so that black pixels have a finite relative error.
inline constexpr double kNoiseEps = 1e-3;

/// From the sums of a pixel: mu = S1/n, s^2 = (S2 - S1^2/n)/(n-1) not below 0, SE = sqrt(s^2/n), RSE = SE / (mu + 1e-3).
/// 0 for n < 2.
/// A mean below 0 (only negative filter lobes make one) counts as 0.
double relativeStandardError(double s1, double s2, uint64_t n);
/// The same, with the exact variance.
double relativeStandardError(const Moments&);

/// The figures of one film.
struct NoiseFigures {
    double noiseRSE = 0;    ///< mean of the pixels' RSE
    double noiseRSE999 = 0; ///< the k-th smallest RSE, k = min(floor(0.999 N), N - 1)
    double noiseQMC = 0;    ///< mean of the pixels' relative error from replicas, over the complete picture
    double imageError = 0;  ///< absolute: sqrt of the mean of SE_QMC^2; estimates the image's luminance RMSE
    /// Relative error of light from surfaces, mean over their area in the picture: the printed figure. 0 if unknown
    double noise = 0;
    /// 95 % upper bound of the true error: compared with --noise. Close to `noise` if many pixels show a surface, much larger if
    /// few do (noiseBound()). 0 if unknown
    double noiseAtMost = 0;
    bool known = false;  ///< some pixel's surface was hit in two replicas
    double coverage = 0; ///< fraction of samples that hit a surface, 0..1
    /// Whether more samples are unnecessary: no surface is in the picture, or the bound is small enough.
    bool reached(double wanted) const { return known ? noiseAtMost <= wanted : coverage == 0; }
};

/// noiseRSE and noiseRSE999 of a set of pixels, which is reordered. {0, 0} if empty.
void summarise(std::vector<double>& rse, double* noiseRSE, double* noiseRSE999);

/// The error of a pixel's mean from its independently scrambled replicas (sampler.h). With R replicas of n_r samples, means m_r,
/// n = sum n_r, m = sum n_r m_r / n:  SE^2 = R/(R-1) sum (n_r/n)^2 (m_r - m)^2, which for equal n_r is sum (m_r - m)^2 / (R
/// ). Unbiased for the variance of m for any dependence of samples within a replica. The moment formula above treats
/// stratified samples as independent and overestimates the noise.
struct ReplicaError {
    double mean = 0;
    double se = 0;    ///< 0 when replicas < 2
    int replicas = 0; ///< replicas with samples
};
/// Of one pixel, from its replicas.
ReplicaError replicaError(const Film&, int x, int y);
/// The same from sums and counts of each replica.
ReplicaError replicaError(std::span<const double> sums, std::span<const uint32_t> counts);
/// SE / (mean + 1e-3), with SE divided by c4(R) = sqrt(2/(R-1)) Gamma(R/2) / Gamma((R-1)/2), because the root of an unbiased
/// variance is too small on average (c4(2) = 0.7979 for normal replica means). 0 for fewer than 2 replicas. For a single pixel
/// with two replicas its standard deviation is 0.76 of its value: use means over many pixels.
double relativeReplicaError(const ReplicaError&);

/// The error of the light of a pixel's surfaces, independent of their coverage. Of n samples h hit a surface, h_r of replica r; L
/// is the mean luminance of these, B that of the others. The deviation of a replica's sum, d_r = Y_r - L h_r - B (n_r - h_r), is
/// due to light only, so that an edge between a lit surface and black, both without noise, has error 0. If light does not depend
/// on the replica, the sum of d_r^2 is var (1 - sum (h_r / h)^2), with var the variance of the sum of the h samples: SE =
/// sqrt(var) / h.
struct SurfaceError {
    double coverage = 0; ///< h / n
    double mean = 0;     ///< L
    double se = 0;       ///< of L; 0 when replicas < 2
    int replicas = 0;    ///< replicas that hit the surface
};
/// Of one pixel, from the samples that hit a surface.
SurfaceError surfaceError(const Film&, int x, int y);
/// The pixel's term of NoiseFigures::noise: SE / (L + 1e-3), unbiased as in relativeReplicaError(), times sqrt(h / n), i.e. the
/// error of a pixel whose n samples all hit the surface. So the position of an object's edge changes the figure only by the
/// object's size in the picture. 0 for fewer than 2 replicas.
double relativeSurfaceError(const SurfaceError&);

/// 95 % upper bound of a mean of relative errors a_i (weights included), each from R replicas. The mean's relative variance, (1 -
/// c4(R)^2) sum a_i^2 / (sum a_i)^2, equals that of a standard deviation with f = 1 / (2 variance) degrees of freedom, whose
/// bound is sqrt(f / chi^2) with chi^2 the 5 % quantile (Wilson and Hilferty 1931). f is small if few pixels have most of the
/// error. Returns the factor, >= 1: 1.01 for 10,000 similar pixels, 13 for one.
double noiseBound(double sum, double sumOfSquares, int replicas = int(kReplicas));

/// A mean and its error pooled over pixels. A single pixel has one degree of freedom: its interval is 12.7 SE wide, and misses
/// the truth whenever both replicas of a binary value agree.
struct PooledError {
    double mean = 0;
    double se = 0;  ///< standard error of the mean
    double dof = 0; ///< degrees of freedom of se; 0: unknown
};
/// The error of the mean luminance over the pixels of a window that have samples: SE^2 = sum SE_i^2 / N^2, for any errors of the
/// pixels. Degrees of freedom by Satterthwaite (1946), unbiased for components of one degree each: 3 (sum v)^2 / sum v^2 - 2, v =
/// SE_i^2, between 1 and the number of pixels.
PooledError windowError(const Film&, const Window&);
/// The error of one pixel's mean, with the variance from the square of 2 radius + 1 pixels around it, clipped to the film's
/// window. Valid if samples there have about the same variance; radius 0 uses the pixel alone.
PooledError pixelError(const Film&, int x, int y, int radius);

/// Mean and half width of an interval that contains the true value with the given probability: m +- t SE, t of Student's
/// distribution. Infinite half width if the error is unknown (fewer than 2 replicas). 0 < level < 1.
struct Interval {
    double mean = 0, halfWidth = 0; ///< m, and t SE
};
/// Around the pooled error, by Student's distribution.
Interval confidenceInterval(const PooledError&, double level = 0.95);
/// t with P(|T| <= t) = level for Student's distribution with dof >= 1 degrees of freedom; for fractional dof its logarithm is
/// interpolated linearly in 1 / dof (2.5 % too large at 1.5, 0.5 % at 2.5).
double studentQuantile(double level, double dof);

/// All figures of a film. noiseRSE and noiseRSE999 are 0 below two samples per pixel.
NoiseFigures noiseFigures(const Film&);

/// 1 / (noiseRSE^2 * renderSec), 0 if either is not positive. Higher is better; independent of the number of samples.
double efficiency(double noiseRSE, double renderSec);
/// Rays per millisecond: totalRays / renderSec / 1000; 0 if no time has passed.
double raysPerMS(uint64_t totalRays, double renderSec);

} // namespace alpenglow::render
