(** * The theorems that kickdrift relies on, on one page

    The words are defined in Vocabulary.v (a few at the head of the file that first needs them); the proofs
    are in the files named. Equation numbers are those of Fong, Darve, Lew, "Stability of Asynchronous
    Variational Integrators". Assumptions.v prints what each theorem rests on.                         *)

From Coq Require Import Reals ZArith List QArith Qreals.
From Kickdrift Require Import
  Vocabulary Algebra TwoClocks Stability SignTable Floquet TanCriterion Respa ImplicitExplicit Closings Proposition Plane Perturbation
  Cone Returns Between Labels Certificate PiCertificate EdgeCertificate.
From Kickdrift Require WordCertificate.
Open Scope R_scope.

(** ** 1. Algebra *)

Theorem det_propagator : forall l, det (propagator l) = 1.
Proof. exact Algebra.det_propagator. Qed.

Theorem propagator_rev : forall l, propagator (rev l) = mirror (propagator l).
Proof. exact Algebra.propagator_rev. Qed.

Theorem palindrome : forall h,
  let H := propagator h in
  let Q := propagator (h ++ rev h) in
  Q = mirror H ** H /\ tr Q = 2 * (mA H * mD H + mB H * mC H) /\
  tr Q - 2 = 4 * (mB H * mC H) /\ tr Q + 2 = 4 * (mA H * mD H).
Proof. exact Algebra.palindrome. Qed.

(** Ticks that strike are exactly the times n h and, for phase 1/2, (n + 1/2) h. *)
Theorem strikes_times : forall q h1 j, (1 <= q)%nat -> 0 < h1 ->
  strikes q false j = true <-> exists n, INR j * tick q h1 = INR n * h1.
Proof. exact TwoClocks.strikes_times. Qed.

Theorem strikes_times_late : forall q h1 j, (1 <= q)%nat -> 0 < h1 ->
  strikes q true j = true <-> exists n, INR j * tick q h1 = (INR n + 1 / 2) * h1.
Proof. exact TwoClocks.strikes_times_late. Qed.

Theorem tick_slow : forall p q h1 h2, (1 <= p)%nat -> (1 <= q)%nat ->
  INR p * h1 = INR q * h2 -> tick q h1 = tick p h2.
Proof. exact TwoClocks.tick_slow. Qed.

Theorem two_clocks_palindrome : forall p q late1 late2 k1 k2 d, (1 <= p)%nat -> (1 <= q)%nat ->
  let f := two_clocks p q late1 late2 k1 k2 in
  let h := schedule f d (p * q) in
  schedule f d (2 * (p * q)) = h ++ rev h.
Proof. exact TwoClocks.two_clocks_palindrome. Qed.

Theorem many_clocks_palindrome : forall clocks d n,
  (forall m late k, In (m, late, k) clocks -> (1 <= m)%nat /\ exists c, n = (c * m)%nat) ->
  let f := many_clocks clocks in
  schedule f d (2 * n) = schedule f d n ++ rev (schedule f d n).
Proof. exact TwoClocks.many_clocks_palindrome. Qed.

Theorem swap_clocks : forall p q h1 L1 h2 L2, (1 <= p)%nat -> (1 <= q)%nat -> INR p * h1 = INR q * h2 ->
  full_period q p h2 L2 h1 L1 = full_period p q h1 L1 h2 L2.
Proof. exact TwoClocks.swap_clocks. Qed.

(** A full kick of the fast (slow) clock stands at T/2 iff p (q) is even. *)
Theorem strikes_middle : forall m n, (1 <= m)%nat -> strikes m false (n * m) = Nat.even n.
Proof. exact TwoClocks.strikes_middle. Qed.

Theorem scaling : forall f d n c, c <> 0 ->
  propagator (schedule (fun j => f j / c) (d * c) n) = rescale c (propagator (schedule f d n)).
Proof. exact Algebra.scaling. Qed.

(** Algorithm 1 (staggered) against the time-symmetric form. *)
Theorem staggered_trace : forall f d n, f n = f O ->
  tr (propagator (staggered f d n)) = tr (propagator (schedule f d n)).
Proof. exact Algebra.staggered_trace. Qed.

Theorem staggered_bounded : forall f d n, f n = f O ->
  bounded_powers (propagator (staggered f d n)) <-> bounded_powers (propagator (schedule f d n)).
Proof. exact SignTable.staggered_bounded. Qed.

(** ** 2. Stability *)

Theorem bounded_iff : forall Q, det Q = 1 ->
  bounded_powers Q <-> -2 < tr Q < 2 \/ Q = one \/ Q = opp one.
Proof. exact Stability.bounded_iff. Qed.

(** The seven rows of the four-sign table; each half period lies in exactly one. *)
Theorem four_signs : forall k H, det H = 1 -> row k H <-> behaves k (mirror H ** H).
Proof. exact SignTable.four_signs. Qed.

Theorem row_total : forall H, exists k, row k H.
Proof. exact SignTable.row_total. Qed.

Theorem row_unique : forall k k' H, det H = 1 -> row k H -> row k' H -> k = k'.
Proof. exact SignTable.row_unique. Qed.

Theorem symmetric_verdict : forall k f d n, (forall j, (j <= 2 * n)%nat -> f (2 * n - j)%nat = f j) ->
  behaves k (propagator (schedule f d (2 * n))) <-> row k (propagator (schedule f d n)).
Proof. exact SignTable.symmetric_verdict. Qed.

Theorem two_clocks_verdict : forall k p q h1 L1 h2 L2, (1 <= p)%nat -> (1 <= q)%nat ->
  behaves k (full_period p q h1 L1 h2 L2) <-> row k (half_period p q h1 L1 h2 L2).
Proof. exact SignTable.two_clocks_verdict. Qed.

(** The growth of one period, without cancellation near |Tr| = 2. *)
Theorem multiplier_plus : forall H, det H = 1 -> 0 < mB H * mC H ->
  ln (multiplier (mirror H ** H)) = 2 * arcsinh (sqrt (mB H * mC H)).
Proof. exact SignTable.multiplier_plus. Qed.

Theorem multiplier_minus : forall H, det H = 1 -> mA H * mD H < 0 ->
  ln (multiplier (mirror H ** H)) = 2 * arcsinh (sqrt (- (mA H * mD H))).
Proof. exact SignTable.multiplier_minus. Qed.

(** Velocity Verlet, eq. (1), sharper than |eigenvalues| <= 1. *)
Theorem verlet : forall h L, h <> 0 ->
  bounded_powers (verlet_matrix h L) <-> 0 < h * h * L < 4.
Proof. exact Stability.verlet. Qed.

(** ** 3. r-RESPA *)

Theorem rotation_power : forall h L th, 0 < h -> 0 < th < PI -> h * h * L = 2 - 2 * cos th -> forall p,
  power (verlet_matrix h L) p =
  diagonal (sin th / h) ** rotation_matrix (INR p * th) ** diagonal (/ (sin th / h)).
Proof. exact Respa.rotation_power. Qed.

Theorem sin_angle : forall h L th, 0 < h -> 0 < L -> 0 < th < PI -> h * h * L = 2 - 2 * cos th ->
  sin th = h * sqrt L * sqrt (1 - h * h * L / 4).
Proof. exact Respa.sin_angle. Qed.

Theorem respa_trace : forall h L th, 0 < h -> 0 < th < PI -> h * h * L = 2 - 2 * cos th -> forall p h2 L2,
  let alpha := h * h2 * L2 / (2 * sin th) in
  tr (respa p h L h2 L2) = 2 * (cos (INR p * th) - alpha * sin (INR p * th)).
Proof. exact Respa.respa_trace. Qed.

Theorem respa_two_clocks : forall p h1 L1 h2 L2, (1 <= p)%nat ->
  full_period p 1 h1 L1 h2 L2 = respa p h1 L1 h2 L2.
Proof. exact Respa.respa_two_clocks. Qed.

Theorem respa_tan : forall p h1 L1 h2 L2 th,
  (1 <= p)%nat -> 0 < h1 -> 0 < th < PI -> h1 * h1 * L1 = 2 - 2 * cos th ->
  let alpha := h1 * h2 * L2 / (2 * sin th) in
  let t := tan (INR p * th / 2) in
  0 < alpha ->
  2 < Rabs (tr (respa p h1 L1 h2 L2)) <->
  cos (INR p * th / 2) <> 0 /\ (0 < 1 / alpha < t \/ - alpha < t < 0).
Proof. exact Respa.respa_tan. Qed.

Theorem respa_window : forall p h1 L1 h2 L2 th,
  0 < h1 -> 0 < th < PI -> h1 * h1 * L1 = 2 - 2 * cos th ->
  let alpha := h1 * h2 * L2 / (2 * sin th) in
  0 < alpha ->
  2 < Rabs (tr (respa p h1 L1 h2 L2)) <->
  exists k, IZR k * PI - 2 * atan alpha < INR p * th < IZR k * PI.
Proof. exact Respa.respa_window. Qed.

(** The fast force L1 >= 0 by the implicit midpoint rule over the whole step: no resonance, whatever L1. *)
Theorem implicit_explicit : forall h L1 L2, 0 < h -> 0 <= L1 ->
  (-2 < tr (implicit_explicit_step h L1 L2) < 2 <-> h * h * L2 < 4 /\ 0 < L1 + L2) /\
  (h * h * L2 < 4 -> 0 < L1 + L2 -> bounded_powers (implicit_explicit_step h L1 L2)) /\
  (4 < h * h * L2 -> exponential_growth (implicit_explicit_step h L1 L2)).
Proof.
  intros; split; [now apply ImplicitExplicit.elliptic_iff | split].
  - now apply ImplicitExplicit.implicit_explicit.
  - now apply ImplicitExplicit.implicit_explicit_beyond.
Qed.

(** ** 4. The Proposition: eq. (9) iff eq. (10) *)

Theorem proposition : forall h1 h2 T, 0 < h1 -> 0 < h2 -> 0 < T ->
  resonant h1 h2 T <-> on_curve h1 h2 T.
Proof. exact Proposition.proposition. Qed.

Theorem proposition_forward : forall h1 h2 T, 0 < h1 -> 0 < T -> forall p q m,
  resonant_with p q m h1 h2 T ->
  exists a b, m = (a * p + b * q)%Z /\ b <> 0%Z /\ on_curve_with a b p q h1 h2 T.
Proof. exact Proposition.forward. Qed.

Theorem proposition_backward : forall h1 h2 T, 0 < h1 -> forall a b p q,
  (0 < p)%Z -> (0 < q)%Z -> Z.gcd p q = 1%Z ->
  on_curve_with a b p q h1 h2 T -> resonant_with p q (a * p + b * q) h1 h2 T.
Proof. exact Proposition.backward. Qed.

(** The gap in the paper's proof: a Bezout pair with b = 0 makes the denominator of (10) vanish. *)
Theorem proposition_gap : forall h1 h2 T, 0 < h1 -> forall p q m a,
  resonant_with p q m h1 h2 T -> m = (a * p + 0 * q)%Z -> h1 - IZR a * T = 0.
Proof. exact Proposition.gap. Qed.

Theorem symmetric_form : forall h1 h2 T, 0 < h1 -> 0 < h2 -> 0 < T -> forall a b,
  h1 - IZR a * T <> 0 ->
  h2 = IZR b * T * h1 / (h1 - IZR a * T) <-> 1 / T = IZR a / h1 + IZR b / h2.
Proof. exact Proposition.symmetric_form. Qed.

Theorem resonant_steps : forall h1 T, 0 < h1 -> forall p q m,
  (0 < p)%Z -> (0 < q)%Z -> Z.gcd p q = 1%Z -> IZR m * T = IZR p * h1 ->
  resonant_with p q m h1 (IZR p / IZR q * h1) T.
Proof. exact Proposition.resonant_steps. Qed.

Theorem sign_of_b : forall h1 h2 T, 0 < h1 -> 0 < h2 -> 0 < T -> forall a b,
  h1 < T -> 1 / T = IZR a / h1 + IZR b / h2 -> ((a <= 0 -> 0 < b) /\ (1 <= a -> b < 0))%Z.
Proof. exact Proposition.sign_of_b. Qed.

(** ** 5. Floquet coordinates *)

Theorem wronskian : forall s n x, det (W s n x) = 1.
Proof. exact Floquet.wronskian. Qed.

Theorem update_kick : forall s n x k,
  kick k ** W s n x =
  W s n x ** update k (even s n x) (odd s n x).
Proof. exact Floquet.update_kick. Qed.

Theorem foreign_kicks : forall s n x kicks, in_order n kicks ->
  let (n', x') := last_time n x kicks in
  propagator (foreign_schedule s n x kicks) ** W s n x =
  W s n' x' ** foreign_updates s kicks.
Proof. exact Floquet.foreign_kicks. Qed.

Theorem foreign_ticks : forall s q g, (1 <= q)%nat -> forall j,
  propagator (schedule (fun i => base s q i + g i) (1 / (2 * INR q)) j) =
  kick (- (base s q j / 2)) ** W s (j / (2 * q)) (INR (j mod (2 * q)) / (2 * INR q)) **
  updates s q g j.
Proof. exact Floquet.foreign_ticks. Qed.

Theorem angle : forall s, 0 < s < 4 -> exists th, 0 < th < PI /\ s = 2 - 2 * cos th.
Proof. exact TanCriterion.angle. Qed.

Theorem cosines : forall s th, s = 2 - 2 * cos th -> forall n, Cn s n = cos (INR n * th).
Proof. exact TanCriterion.cosines. Qed.

Theorem sines : forall s th, s = 2 - 2 * cos th -> forall n, Sn s n * sin th = sin (INR n * th).
Proof. exact TanCriterion.sines. Qed.

(** The update in the coordinates (c_E, c_O = d / sin th): beta = k / sin th. *)
Theorem trig_update : forall th, 0 < th < PI -> forall k e o,
  rescale (sin th) (update k e o) = update (k / sin th) e (sin th * o).
Proof. exact TanCriterion.trig_update. Qed.

(** The four signs of the half period are those of four linear forms in cos (p th / 2), sin (p th / 2). *)
Theorem four_forms : forall p q h1 L1 h2 L2 th,
  (1 <= q)%nat -> 0 < h1 -> 0 < th < PI -> h1 * h1 * L1 = 2 - 2 * cos th ->
  let H := half_period p q h1 L1 h2 L2 in
  exists x y, 0 < x /\ 0 < y /\
    mA H = x * formA p q h1 L1 h2 L2 th /\
    mB H = y * formB p q h1 L1 h2 L2 th /\
    mC H = formC p q h1 L1 h2 L2 th / y /\
    mD H = formD p q h1 L1 h2 L2 th / x.
Proof. exact TanCriterion.four_forms. Qed.

Theorem tan_criterion : forall p q h1 L1 h2 L2 th,
  (1 <= p)%nat -> (1 <= q)%nat -> 0 < h1 -> 0 < th < PI -> h1 * h1 * L1 = 2 - 2 * cos th ->
  let Q := full_period p q h1 L1 h2 L2 in
  let G := gather p q h1 L1 h2 L2 th in
  let phi := INR p * th / 2 in
  let t := tan phi in
  (cos phi <> 0 ->
     (2 < tr Q  <-> 0 < (mB G + mD G * t) * (mC G - mA G * t)) /\
     (tr Q < -2 <-> (mA G + mC G * t) * (mD G - mB G * t) < 0)) /\
  (cos phi = 0 ->
     (2 < tr Q  <-> mA G * mD G < 0) /\
     (tr Q < -2 <-> 0 < mB G * mC G)).
Proof. exact TanCriterion.tan_criterion. Qed.

Theorem tan_criterion_q1 : forall p h1 L1 h2 L2 th,
  (1 <= p)%nat -> 0 < h1 -> 0 < th < PI -> h1 * h1 * L1 = 2 - 2 * cos th ->
  let phi := INR p * th / 2 in
  let alpha := h1 * h2 * L2 / (2 * sin th) in
  let Q := full_period p 1 h1 L1 h2 L2 in
  let t := tan phi in
  (cos phi <> 0 -> (2 < tr Q <-> t * (t + alpha) < 0) /\ (tr Q < -2 <-> 1 < alpha * t)) /\
  (cos phi = 0 -> tr Q = -2).
Proof. exact TanCriterion.tan_criterion_q1_signs. Qed.

Theorem tan_criterion_q2 : forall p h1 L1 h2 L2 th,
  (1 <= p)%nat -> 0 < h1 -> 0 < th < PI -> h1 * h1 * L1 = 2 - 2 * cos th -> Nat.Odd p ->
  let phi := INR p * th / 2 in
  let alpha := h1 * h2 * L2 / (2 * sin th) in
  let c2 := cos (th / 2) * cos (th / 2) in
  let Q := full_period p 2 h1 L1 h2 L2 in
  let t := tan phi in
  (cos phi <> 0 ->
     (2 < tr Q  <-> t * (t * (1 - alpha * alpha * c2) + alpha * (1 + c2)) < 0) /\
     (tr Q < -2 <-> (1 - alpha * t) * (1 - alpha * c2 * t) < 0)) /\
  (cos phi = 0 -> (2 < tr Q <-> 1 < alpha * alpha * c2) /\ ~ tr Q < -2).
Proof. exact TanCriterion.tan_criterion_q2. Qed.

(** No tongue closes where one of the clocks kicks once or twice a period. *)
Theorem no_closing_q1 : forall p h1 L1 h2 L2,
  (1 <= p)%nat -> h1 <> 0 -> h2 * L2 <> 0 ->
  full_period p 1 h1 L1 h2 L2 <> one /\ full_period p 1 h1 L1 h2 L2 <> opp one.
Proof. exact Closings.no_closing_q1. Qed.

Theorem no_closing_q2 : forall p h1 L1 h2 L2,
  Nat.Odd p -> h1 <> 0 -> L1 <> 0 -> h2 * L2 <> 0 ->
  let H := half_period p 2 h1 L1 h2 L2 in
  ~ (mB H = 0 /\ mC H = 0) /\ ~ (mA H = 0 /\ mD H = 0).
Proof. exact Closings.no_closing_q2. Qed.

Theorem no_closing_p1 : forall q h1 L1 h2 L2,
  (1 <= q)%nat -> h1 = INR q * h2 -> h2 <> 0 -> h1 * L1 <> 0 ->
  full_period 1 q h1 L1 h2 L2 <> one /\ full_period 1 q h1 L1 h2 L2 <> opp one.
Proof. exact Closings.no_closing_p1. Qed.

Theorem no_closing_p2 : forall q h1 L1 h2 L2,
  Nat.Odd q -> 2 * h1 = INR q * h2 -> h2 <> 0 -> L2 <> 0 -> h1 * L1 <> 0 ->
  let H := half_period 2 q h1 L1 h2 L2 in
  ~ (mB H = 0 /\ mC H = 0) /\ ~ (mA H = 0 /\ mD H = 0).
Proof. exact Closings.no_closing_p2. Qed.

(** ** 6. Rounding and cones *)

(** Vectors of the plane with the Euclidean length; J is the quarter turn. Steps k = 0 ... n - 1. *)
Section Orbit.
Variables (M : nat -> mat) (u uh r : nat -> vec) (b : nat -> R) (n : nat) (kappa eps g tau : R).
Let omega := g * eps + g * kappa * tau.
Hypothesis start : u O = uh O.
Hypothesis exact_steps : forall k, (k < n)%nat -> u (S k) = M k @ u k.
Hypothesis computed_steps : forall k, (k < n)%nat -> uh (S k) = add (M k @ uh k) (r k).
Hypothesis unimodular : forall k, (k < n)%nat -> det (M k) = 1.
Hypothesis contained : forall k y, (k < n)%nat -> len (M k @ y) <= kappa * len y.
Hypothesis nonzero : forall k, (k <= n)%nat -> uh k <> zero.
Hypothesis residual : forall k, (k < n)%nat -> len (r k) <= eps * len (uh k).
Hypothesis shrink : forall k, (k < n)%nat -> len (uh k) <= g * len (uh (S k)).
Hypothesis b_start : 0 <= b O.
Hypothesis b_step : forall k, (k < n)%nat -> b k + len (r k) * len (uh (S k)) <= b (S k).
Hypothesis b_small : forall k, (k < n)%nat -> 2 * b k <= tau * (len (uh k) * len (uh k)).
Hypotheses (g_nonneg : 0 <= g) (tau_nonneg : 0 <= tau).
Hypothesis budget : INR n * (kappa * eps + omega) <= 1 / 2.

Theorem perturbed_orbit : forall k, (k <= n)%nat ->
  exists a t,
    u k = smul a (add (uh k) (smul (t / (len (uh k) * len (uh k))) (J (uh k)))) /\
    Rabs t <= 2 * b k /\
    (1 - omega) ^ k <= a <= (1 + omega) ^ k /\
    0 < a /\ 1 - INR k * omega <= a <= / (1 - INR k * omega).
Proof. eapply Perturbation.perturbed_orbit; eassumption. Qed.

Theorem sign_certificate : forall k v, (k <= n)%nat ->
  2 * b k * len v < Rabs (dot v (uh k)) * len (uh k) ->
  0 < dot v (u k) * dot v (uh k).
Proof. eapply Perturbation.sign_certificate; eassumption. Qed.

(** The form v is meant, vh is at hand. *)
Theorem sign_certificate_rounded : forall k v vh delta, (k <= n)%nat ->
  len (add v (smul (-1) vh)) <= delta ->
  2 * b k * (len vh + delta) + delta * (len (uh k) * len (uh k)) < Rabs (dot vh (uh k)) * len (uh k) ->
  0 < dot v (u k) * dot vh (uh k).
Proof. eapply Perturbation.sign_certificate_rounded; eassumption. Qed.
End Orbit.

(** The same with each step's own constants: w sums what may stretch, c what may turn the error (x each time). *)
Section Stepwise.
Variables (M : nat -> mat) (u uh r : nat -> vec) (b w c : nat -> R) (n : nat) (kappa x : nat -> R).
Let tau k := 2 * b k / (len (uh k) * len (uh k)).
Let omega k := (len (r k) + kappa k * tau k * len (uh k)) / len (uh (S k)).
Hypothesis start : u O = uh O.
Hypothesis exact_steps : forall k, (k < n)%nat -> u (S k) = M k @ u k.
Hypothesis computed_steps : forall k, (k < n)%nat -> uh (S k) = add (M k @ uh k) (r k).
Hypothesis unimodular : forall k, (k < n)%nat -> det (M k) = 1.
Hypothesis contained : forall k y, (k < n)%nat -> len (M k @ y) <= kappa k * len y.
Hypothesis nonzero : forall k, (k <= n)%nat -> uh k <> zero.
Hypothesis b_start : 0 <= b O.
Hypothesis b_step : forall k, (k < n)%nat -> b k + len (r k) * len (uh (S k)) <= b (S k).
Hypotheses (w_start : 0 <= w O) (c_start : 0 <= c O).
Hypothesis w_step : forall k, (k < n)%nat -> w k + omega k <= w (S k).
Hypothesis turn : forall k, (k < n)%nat -> Rabs (cross (r k) (M k @ J (uh k))) <= x k * (len (uh k) * len (uh k)).
Hypothesis c_step : forall k, (k < n)%nat -> c k + x k <= c (S k).
Hypothesis budget : w n + c n <= 1 / 2.

Theorem perturbed_orbit_stepwise : forall k, (k <= n)%nat ->
  exists a t,
    u k = smul a (add (uh k) (smul (t / (len (uh k) * len (uh k))) (J (uh k)))) /\
    Rabs t <= 2 * b k /\
    0 < a /\ 1 - w k <= a <= / (1 - w k).
Proof. eapply Perturbation.perturbed_orbit_stepwise; eassumption. Qed.
End Stepwise.

(** So x = |r|/|uh| for a kick that errs in v and a drift that errs in x. *)
Theorem shear_turn : forall k t e y,
  Rabs (cross (Vec 0 e) (kick k @ J y)) <= Rabs e * len y /\
  Rabs (cross (Vec e 0) (drift t @ J y)) <= Rabs e * len y.
Proof. exact Perturbation.shear_turn. Qed.

(** Where kappa and g come from. *)
Theorem update_contained : forall k e o y,
  det (update k e o) = 1 /\ len (update k e o @ y) <= (1 + Rabs k * (e * e + o * o)) * len y.
Proof. exact Perturbation.update_contained. Qed.

Theorem contained_inverse : forall M kappa, det M = 1 ->
  (forall y, len (M @ y) <= kappa * len y) -> forall y, len y <= kappa * len (M @ y).
Proof. exact Perturbation.contained_inverse. Qed.

Theorem shrink_bound : forall M uh r kappa eps, det M = 1 ->
  (forall y, len (M @ y) <= kappa * len y) -> 0 <= kappa -> kappa * eps < 1 -> len r <= eps * len uh ->
  len uh <= kappa / (1 - kappa * eps) * len (add (M @ uh) r).
Proof. exact Perturbation.shrink_bound. Qed.

Theorem cone_chain : forall M u w n,
  (forall k, (k < n)%nat ->
     in_cone (u (S k)) (w (S k)) (M k @ u k) /\ in_cone (u (S k)) (w (S k)) (M k @ w k)) ->
  forall v, in_cone (u O) (w O) v -> in_cone (u n) (w n) (product M n @ v).
Proof. exact Cone.cone_chain. Qed.

Theorem cone_criterion : forall Q u w, det Q = 1 -> cross u w <> 0 ->
  (inside u w (Q @ u) -> inside u w (Q @ w) -> 2 < tr Q) /\
  (inside u w (smul (-1) (Q @ u)) -> inside u w (smul (-1) (Q @ w)) -> tr Q < -2).
Proof. exact Cone.cone_criterion. Qed.

(** ** 7. Return maps (Returns.v has the levels, their branches and the walk) *)

(** A slow kick at the offset x behind a fast kick, pulled back to that fast kick. *)
Theorem pulled_back : forall k x,
  drift (- x) ** kick k ** drift x = Mat (1 + k * x) (k * (x * x)) (- k) (1 - k * x).
Proof. exact Returns.pulled_back. Qed.

(** After any number of Euclid's steps the branches are the products over the kicks up to the return, heights times widths
    sum to the whole length, ... *)
Theorem deep_level : forall a b kicked k, 0 <= a -> 0 <= b ->
  let l := deep a b kicked k in
  0 <= left_width l /\ 0 <= right_width l /\ returns a b kicked l /\ area l = a + b.
Proof. exact Returns.deep_level. Qed.

(** ... where the left interval has shrunk to nothing the right branch at 0 is the product over the period, ... *)
Theorem last_period : forall a b kicked k, 0 <= a -> 0 <= b -> 0 < a + b ->
  let l := deep a b kicked k in
  left_width l = 0 ->
  let n := right_height l in
  INR n * right_width l = a + b /\ turns a b n 0 = 0 /\ right_branch l 0 = along a b kicked n 0.
Proof. exact Returns.last_period. Qed.

(** ... and any walk over levels that uses up n kicks multiplies to the product over the next n kicks. *)
Theorem walk_product : forall a b kicked n x P, walk a b kicked n x P -> P = along a b kicked n x.
Proof. exact Returns.walk_product. Qed.

(** Matrices that map one cone into its interior (or into the opposite one) by a margin d, in any order. *)
Theorem band_growth : forall M u w d n,
  cross u w <> 0 -> 0 <= d ->
  (forall k, det (M k) = 1 /\ (inside_by d u w (M k) \/ inside_by d u w (opp (M k)))) ->
  forall x y, 0 < x -> 0 < y -> exists s x' y',
    (s = 1 \/ s = -1) /\ 0 < x' /\ 0 < y' /\ (1 + 4 * d) ^ n * (x * y) <= x' * y' /\
    Cone.product M n @ add (smul x u) (smul y w) = smul s (add (smul x' u) (smul y' w)).
Proof. exact Returns.band_growth. Qed.

(** A period of such matrices is hyperbolic, ... *)
Theorem band_unstable : forall M u w d n,
  cross u w <> 0 -> 0 <= d ->
  (forall k, det (M k) = 1 /\ (inside_by d u w (M k) \/ inside_by d u w (opp (M k)))) ->
  2 < Rabs (tr (Cone.product M (S n))) /\ exponential_growth (Cone.product M (S n)).
Proof. exact Returns.band_unstable. Qed.

(** ... also where the kicks are seen in a frame that turns with the offset: the products are turned at both ends. *)
Theorem turning_along : forall (T T' : R -> mat) a b kicked n x,
  (forall y, T' y ** T y = one) -> (forall y, T y ** T' y = one) ->
  along a b (fun y => T (turn a b y) ** kicked y ** T' y) n x
  = T (turns a b n x) ** along a b kicked n x ** T' x.
Proof. exact Returns.turning_along. Qed.

(** ** 8. Unstable at two steps with one label (Between.v and Labels.v have the words: lifts, arcs, shears, labels) *)

(** The step in between (f) turns less far than the smaller one (g), further than the larger one (h), clockwise being
    downwards. Where g turns beta by N half turns at least and h turns alpha by N at most, in chains of inequalities that are
    strict for f once, the period of f maps an arc into itself after N half turns. *)
Theorem between : forall f g h alpha beta n N,
  (forall k, (k < n)%nat -> lift (f k) /\ forall x, h k x <= f k x <= g k x) ->
  (forall k, (k < n)%nat -> g k (beta k) <= beta (S k)) ->
  (forall k, (k < n)%nat -> alpha (S k) <= h k (alpha k)) ->
  (exists k, (k < n)%nat /\ f k (beta k) < beta (S k)) ->
  (exists k, (k < n)%nat /\ alpha (S k) < f k (alpha k)) ->
  beta n <= beta O - IZR N * PI -> alpha O - IZR N * PI <= alpha n ->
  exists j, let a := alpha O + IZR j * PI in let b := beta O in let F := compose f n in
    a < b < a + PI /\ a < F a + IZR N * PI /\ F a < F b /\ F b + IZR N * PI < b.
Proof. exact Between.between. Qed.

(** A matrix that does so is hyperbolic, and the parity of N says on which side. *)
Theorem arc_hyperbolic : forall Q a b x y c d N,
  det Q = 1 -> a < b < a + PI ->
  0 < c -> Q @ direction a = smul c (direction x) ->
  0 < d -> Q @ direction b = smul d (direction y) ->
  a < x + IZR N * PI < b -> a < y + IZR N * PI < b ->
  2 < Rabs (tr Q) /\ exponential_growth Q /\
  (Z.Even N -> 2 < tr Q) /\ (Z.Odd N -> tr Q < -2).
Proof. exact Between.arc_hyperbolic. Qed.

Theorem between_unstable : forall M f g h alpha beta n N,
  (forall k, (k < n)%nat -> det (M k) = 1 /\ sends (M k) (f k)) ->
  (forall k, (k < n)%nat -> lift (f k) /\ forall x, h k x <= f k x <= g k x) ->
  (forall k, (k < n)%nat -> g k (beta k) <= beta (S k)) ->
  (forall k, (k < n)%nat -> alpha (S k) <= h k (alpha k)) ->
  (exists k, (k < n)%nat /\ f k (beta k) < beta (S k)) ->
  (exists k, (k < n)%nat /\ alpha (S k) < f k (alpha k)) ->
  beta n <= beta O - IZR N * PI -> alpha O - IZR N * PI <= alpha n ->
  let Q := Cone.product M n in
  2 < Rabs (tr Q) /\ exponential_growth Q /\
  (Z.Even N -> 2 < tr Q) /\ (Z.Odd N -> tr Q < -2).
Proof. exact Between.between_unstable. Qed.

(** The maps of angles exist, ... *)
Theorem turned_lift : forall M, det M = 1 -> clockwise M ->
  sends M (turned M) /\ lift (turned M) /\ forall x, x - PI < turned M x <= x.
Proof. exact Between.turned_lift. Qed.

Theorem further_turned : forall M M' x, clockwise M -> clockwise M' ->
  0 <= cross (M' @ direction x) (M @ direction x) -> turned M' x <= turned M x.
Proof. exact Between.further_turned. Qed.

(** ... also of kicks and drifts, and the larger ones turn further. *)
Theorem clockwise_shear : forall kicks s, 0 <= s -> det (shear kicks s) = 1 /\ clockwise (shear kicks s).
Proof. exact Between.clockwise_shear. Qed.

Theorem further_shear : forall kicks s s' x, 0 <= s <= s' ->
  turned (shear kicks s') x <= turned (shear kicks s) x.
Proof. exact Between.further_shear. Qed.

Theorem between_shears : forall kicks s low high alpha beta n N,
  (forall k, (k < n)%nat -> 0 <= low k <= s k /\ s k <= high k) ->
  (forall k, (k < n)%nat -> at_strength kicks low k (beta k) <= beta (S k)) ->
  (forall k, (k < n)%nat -> alpha (S k) <= at_strength kicks high k (alpha k)) ->
  (exists k, (k < n)%nat /\ at_strength kicks s k (beta k) < beta (S k)) ->
  (exists k, (k < n)%nat /\ alpha (S k) < at_strength kicks s k (alpha k)) ->
  beta n <= beta O - IZR N * PI -> alpha O - IZR N * PI <= alpha n ->
  let Q := Cone.product (fun k => shear (kicks k) (s k)) n in
  2 < Rabs (tr Q) /\ exponential_growth Q /\
  (Z.Even N -> 2 < tr Q) /\ (Z.Odd N -> tr Q < -2).
Proof. exact Between.between_shears. Qed.

(** One direction x at the smaller step, one direction y at the larger one, a kick next to a drift that both grow. *)
Theorem between_steps : forall kicks s low high x y n N j,
  (forall k, (k < n)%nat -> 0 <= low k <= s k /\ s k <= high k) ->
  (S j < n)%nat -> kicks (S j) = negb (kicks j) -> low j < s j < high j -> low (S j) < s (S j) < high (S j) ->
  compose (at_strength kicks low) n x <= x - IZR N * PI ->
  y - IZR N * PI <= compose (at_strength kicks high) n y ->
  let Q := Cone.product (fun k => shear (kicks k) (s k)) n in
  2 < Rabs (tr Q) /\ exponential_growth Q /\
  (Z.Even N -> 2 < tr Q) /\ (Z.Odd N -> tr Q < -2).
Proof. exact Between.between_steps. Qed.

(** A list of kicks and drifts of strength >= 0 has a label where it keeps a line: the half turns which that line makes. *)
Theorem label_exists : forall l, forward l -> (exists N, label l N) <-> 2 <= Rabs (tr (propagator l)).
Proof. exact Labels.label_exists. Qed.

Theorem label_unique : forall l M N, forward l -> label l M -> label l N -> M = N.
Proof. exact Labels.label_unique. Qed.

Theorem label_side : forall l N, forward l -> label l N ->
  (0 <= N)%Z /\ 2 <= (if Z.even N then 1 else -1) * tr (propagator l).
Proof. exact Labels.label_side. Qed.

(** All strengths in proportion to the step: the label does not fall, ... *)
Theorem label_grows : forall w low high M N, forward w -> 0 <= low <= high ->
  label (at_step low w) M -> label (at_step high w) N -> (M <= N)%Z.
Proof. exact Labels.label_grows. Qed.

(** ... and where it is the same at two steps, all steps in between have it, and are hyperbolic. *)
Theorem label_between : forall w low h high N,
  forward w -> touching w -> 0 <= low < h -> h < high ->
  label (at_step low w) N -> label (at_step high w) N ->
  let Q := propagator (at_step h w) in
  label (at_step h w) N /\ 2 < Rabs (tr Q) /\ exponential_growth Q /\
  (Z.Even N -> 2 < tr Q) /\ (Z.Odd N -> tr Q < -2).
Proof. exact Labels.label_between. Qed.

(** Two clocks with h1 = h, h2 = (p/q) h and stiffnesses >= 0, not both 0. *)
Theorem two_clocks_between : forall p q L1 L2 low h high N,
  (1 <= p)%nat -> (1 <= q)%nat -> 0 <= L1 -> 0 <= L2 -> 0 < L1 + L2 -> 0 <= low < h -> h < high ->
  label (period p q L1 L2 low) N -> label (period p q L1 L2 high) N ->
  let Q := full_period p q h L1 (INR p / INR q * h) L2 in
  label (period p q L1 L2 h) N /\ 2 < Rabs (tr Q) /\ exponential_growth Q /\
  (Z.Even N -> 2 < tr Q) /\ (Z.Odd N -> tr Q < -2).
Proof. exact Labels.two_clocks_between. Qed.

(** ** 9. Certificates *)

Theorem certificate : forall k p q (h1 L1 h2 L2 : Q) x1 l1 x2 l2,
  x1 = Q2R h1 -> l1 = Q2R L1 -> x2 = Q2R h2 -> l2 = Q2R L2 ->
  check k p q h1 L1 h2 L2 = true ->
  verdict k p q x1 l1 x2 l2.
Proof. exact Certificate.certificate. Qed.

(** Numbers c pi^e, as pairs (c, e); [bits] are tried one after the other. *)
Theorem certificate_pi : forall bits k p q (h1 L1 h2 L2 : Q * Z) x1 l1 x2 l2,
  x1 = times_pi h1 -> l1 = times_pi L1 -> x2 = times_pi h2 -> l2 = times_pi L2 ->
  search bits (fun b => check_pi b k p q h1 L1 h2 L2) = true ->
  verdict k p q x1 l1 x2 l2.
Proof. exact PiCertificate.certificate_pi. Qed.

(** At fixed p/q and rho entry x of the half period has a zero s between a and b. *)
Theorem edge_between : forall x p q (rho a b : Q) r l u,
  r = Q2R rho -> l = Q2R a -> u = Q2R b ->
  check_edge x p q rho a b = true ->
  edge x p q r l u.
Proof. exact EdgeCertificate.edge_between. Qed.

(** A word of kicks, drifts and implicit midpoints with rational coefficients at a rational step. *)
Theorem word_certificate : forall k letters (h L1 L2 : Q) x l1 l2,
  x = Q2R h -> l1 = Q2R L1 -> l2 = Q2R L2 ->
  WordCertificate.check k letters h L1 L2 = true ->
  WordCertificate.word_verdict k letters x l1 l2.
Proof. exact WordCertificate.word_certificate. Qed.
