(** * r-RESPA: h2 = p h1

    Fast steps are velocity Verlet with cos th = 1 - h1^2 L1 / 2; a half slow kick stands at either end.

    - [sin_angle]          sin th = h1 sqrt L1 sqrt (1 - h1^2 L1 / 4);
    - [rotation]           Q_fast = G R(th) G^-1, G = diag (1, sqrt L1 sqrt (1 - h1^2 L1 / 4)) diagonal;
    - [rotation_power]     Q_fast^p = G R(p th) G^-1;
    - [respa_two_clocks]   r-RESPA is the case q = 1 of two clocks;
    - [respa_trace]        Tr = 2 (cos (p th) - alpha sin (p th)), alpha = h1 h2 L2 / (2 sin th);
    - [respa_tan]          |Tr| > 2 iff tan (p th / 2) > 1/alpha or 0 > tan (p th / 2) > - alpha;
    - [respa_window]       |Tr| > 2 iff p th lies in (k pi - 2 arctan alpha, k pi) for an integer k.    *)

From Kickdrift Require Import Vocabulary Algebra TwoClocks Stability Floquet TanCriterion.
From Coq Require Import Reals Arith ZArith Lia Lra Psatz.
Open Scope R_scope.

Definition rotation_matrix (th : R) := Mat (cos th) (sin th) (- sin th) (cos th).
Definition diagonal (g : R) := Mat 1 0 0 g.

(** The paper's Q_r-RESPA = V_slow (Q_fast)^p V_slow, with Q_fast = Q_VV(h1, L1). *)
Definition respa (p : nat) (h1 L1 h2 L2 : R) :=
  kick (h2 * L2 / 2) ** power (verlet_matrix h1 L1) p ** kick (h2 * L2 / 2).

Theorem sin_angle h L th :
  0 < h -> 0 < L -> 0 < th < PI -> h * h * L = 2 - 2 * cos th ->
  sin th = h * sqrt L * sqrt (1 - h * h * L / 4).
Proof.
  intros H L0 T E; pose proof (sin_pos th T) as S; pose proof (sin2_cos2 th) as SC; unfold Rsqr in SC.
  assert (C : -1 <= cos th <= 1) by apply COS_bound.
  pose proof (sqrt_pos L); pose proof (sqrt_pos (1 - h * h * L / 4)).
  pose proof (sqrt_sqrt L ltac:(lra)) as S1; pose proof (sqrt_sqrt (1 - h * h * L / 4) ltac:(lra)) as S2.
  apply Rsqr_inj; [lra | apply Rmult_le_pos; [nra | assumption] |]; unfold Rsqr.
  transitivity (h * h * (sqrt L * sqrt L) * (sqrt (1 - h * h * L / 4) * sqrt (1 - h * h * L / 4))); [|ring].
  rewrite S1, S2, E; nra.
Qed.

Section Rotation.
Variables (h L th : R).
Hypotheses (h_pos : 0 < h) (th_range : 0 < th < PI) (s_th : h * h * L = 2 - 2 * cos th).
Let g := sin th / h.

Lemma g_pos : 0 < g.
Proof. apply Rdiv_lt_0_compat; [apply (sin_pos th th_range) | assumption]. Qed.

Theorem rotation : verlet_matrix h L = diagonal g ** rotation_matrix th ** diagonal (/ g).
Proof.
  pose proof g_pos as G; pose proof (sin_pos th th_range) as S; pose proof (sin2_cos2 th) as SC; unfold Rsqr in SC.
  rewrite verlet_entries; apply mat_ext; simpl; [lra | unfold g; field; lra | | field_simplify; lra].
  unfold g; apply Rmult_eq_reg_r with h; [|lra].
  transitivity (- (h * h * L * (1 - h * h * L / 4))); [ring|]; rewrite s_th.
  transitivity (- (sin th * sin th)); [nra | field; lra].
Qed.

Lemma rotation_add x y : rotation_matrix x ** rotation_matrix y = rotation_matrix (x + y).
Proof. apply mat_ext; simpl; rewrite ?cos_plus, ?sin_plus; ring. Qed.

Theorem rotation_power p :
  power (verlet_matrix h L) p = diagonal g ** rotation_matrix (INR p * th) ** diagonal (/ g).
Proof.
  pose proof g_pos as G.
  induction p as [|p IH].
  - simpl; rewrite Rmult_0_l; apply mat_ext; simpl; rewrite ?cos_0, ?sin_0; field; lra.
  - simpl power; rewrite IH, rotation.
    replace (INR (S p) * th) with (th + INR p * th) by (rewrite S_INR; ring).
    rewrite <- rotation_add; generalize (rotation_matrix th) (rotation_matrix (INR p * th)); intros M N.
    apply mat_ext; simpl; field; lra.
Qed.

Theorem respa_trace p h2 L2 :
  let alpha := h * h2 * L2 / (2 * sin th) in
  tr (respa p h L h2 L2) = 2 * (cos (INR p * th) - alpha * sin (INR p * th)).
Proof.
  intros alpha; pose proof (sin_pos th th_range) as S.
  unfold respa; rewrite rotation_power; unfold tr, g, alpha; simpl; field; lra.
Qed.
End Rotation.

(** ** r-RESPA among two clocks *)

Lemma odd_silent p k1 k2 n : (1 <= p)%nat -> two_clocks p 1 false false k1 k2 (S (2 * n)) = 0.
Proof.
  intros P; unfold two_clocks.
  assert (Z : forall m, (1 <= m)%nat -> strikes m false (S (2 * n)) = false).
  { intros m M; apply Bool.not_true_iff_false; rewrite strikes_spec by assumption; intros [e E]; nia. }
  rewrite !Z by lia; ring.
Qed.

Theorem respa_two_clocks p h1 L1 h2 L2 :
  (1 <= p)%nat -> full_period p 1 h1 L1 h2 L2 = respa p h1 L1 h2 L2.
Proof.
  intros P; unfold full_period, respa.
  set (k1 := h1 * L1); set (k2 := h2 * L2); set (f := two_clocks p 1 false false k1 k2).
  replace (tick 1 h1) with (h1 / 2) by (unfold tick; simpl; field).
  set (g := slow_kicks p k2).
  assert (Ev : forall n, f (2 * n)%nat = k1 + g (2 * n)%nat).
  { intros n; unfold f, two_clocks, g, slow_kicks; f_equal.
    replace (strikes 1 false (2 * n)) with true; [reflexivity|].
    symmetry; apply strikes_spec; [lia | exists n; lia]. }
  assert (Two : forall n, propagator (schedule f (h1 / 2) (2 * S n)) =
    kick (g (2 * S n)%nat / 2) ** (verlet_matrix h1 L1 ** (kick (g (2 * n)%nat / 2) ** propagator (schedule f (h1 / 2) (2 * n))))).
  { intros n; replace (2 * S n)%nat with (S (S (2 * n))) at 1 by lia.
    rewrite !propagator_schedule_succ; replace (f (S (2 * n))) with 0 by (symmetry; now apply odd_silent).
    replace (S (S (2 * n))) with (2 * S n)%nat by lia; rewrite !Ev; unfold verlet_matrix; fold k1.
    generalize (propagator (schedule f (h1 / 2) (2 * n))); intros M; apply mat_ext; simpl; field. }
  assert (Inner : forall n, (n < p)%nat ->
    kick (g (2 * n)%nat / 2) ** propagator (schedule f (h1 / 2) (2 * n)) = power (verlet_matrix h1 L1) n ** kick (k2 / 2)).
  { induction n as [|n IH]; intros N.
    - unfold g; rewrite Nat.mul_0_r, slow_start by assumption; simpl; now rewrite mul_one_l, mul_one_r.
    - rewrite Two, IH by lia; unfold g; rewrite slow_between by lia.
      replace (0 / 2) with 0 by field; rewrite kick_zero, !mul_one_l, mul_assoc; reflexivity. }
  replace (2 * (p * 1))%nat with (2 * S (pred p))%nat by lia.
  rewrite Two, Inner by lia; unfold g; replace (2 * S (pred p))%nat with (1 * (2 * p))%nat by lia.
  replace (slow_kicks p k2 (1 * (2 * p))) with k2.
  2: { unfold slow_kicks; replace (strikes p false (1 * (2 * p))) with true; [reflexivity|].
       symmetry; apply strikes_spec; [assumption | exists 1%nat; lia]. }
  rewrite !mul_assoc; f_equal; rewrite <- mul_assoc; f_equal.
  change (verlet_matrix h1 L1 ** power (verlet_matrix h1 L1) (pred p)) with (power (verlet_matrix h1 L1) (S (pred p))).
  f_equal; lia.
Qed.

Theorem respa_tan p h1 L1 h2 L2 th :
  (1 <= p)%nat -> 0 < h1 -> 0 < th < PI -> h1 * h1 * L1 = 2 - 2 * cos th ->
  let alpha := h1 * h2 * L2 / (2 * sin th) in
  let t := tan (INR p * th / 2) in
  0 < alpha ->
  2 < Rabs (tr (respa p h1 L1 h2 L2)) <->
  cos (INR p * th / 2) <> 0 /\ (0 < 1 / alpha < t \/ - alpha < t < 0).
Proof.
  intros P H T E alpha t A; rewrite <- respa_two_clocks by assumption.
  exact (tan_criterion_q1 p h1 L1 h2 L2 th P H T E A).
Qed.

(** ** The windows below the resonances *)

Lemma sin_sqr_shift_nat x n : sin (x + INR n * PI) * sin (x + INR n * PI) = sin x * sin x.
Proof.
  induction n as [|n IH]; [simpl; now rewrite Rmult_0_l, Rplus_0_r|].
  replace (x + INR (S n) * PI) with (x + INR n * PI + PI) by (rewrite S_INR; ring).
  rewrite neg_sin, <- IH; ring.
Qed.

Lemma sin_sqr_shift x k : sin (x + IZR k * PI) * sin (x + IZR k * PI) = sin x * sin x.
Proof.
  destruct (Z_le_gt_dec 0 k) as [K|K].
  - replace (IZR k) with (INR (Z.to_nat k)) by (rewrite INR_IZR_INZ; f_equal; lia); apply sin_sqr_shift_nat.
  - rewrite <- (sin_sqr_shift_nat (x + IZR k * PI) (Z.to_nat (- k))), INR_IZR_INZ.
    replace (IZR (Z.of_nat (Z.to_nat (- k)))) with (- IZR k) by (rewrite <- opp_IZR; f_equal; lia).
    replace (x + IZR k * PI + - IZR k * PI) with x by ring; reflexivity.
Qed.

Lemma near_multiple y d :
  0 < d < PI / 2 -> sin y * sin y < sin d * sin d <-> exists k, IZR k * PI - d < y < IZR k * PI + d.
Proof.
  intros D; pose proof PI_RGT_0 as Pi.
  assert (Sd : 0 < sin d) by (apply sin_gt_0; lra).
  assert (Near : forall z, - (PI / 2) <= z <= PI / 2 -> sin z * sin z < sin d * sin d <-> - d < z < d).
  { intros z Z; split; intros H.
    - split; apply Rnot_le_lt; intros B; (assert (sin z <= sin (- d) \/ sin d <= sin z) as [X|X];
        [first [left; apply sin_incr_1; lra | right; apply sin_incr_1; lra]
        | rewrite sin_neg in X; nra | nra]).
    - assert (sin (- d) < sin z) by (apply sin_increasing_1; lra).
      assert (sin z < sin d) by (apply sin_increasing_1; lra).
      rewrite sin_neg in *; nra. }
  split.
  - intros H; destruct (archimed (y / PI - 1 / 2)) as [A1 A2].
    set (k := up (y / PI - 1 / 2)) in *; exists k.
    assert (Y : y = y / PI * PI) by (field; lra).
    assert (Z : - (PI / 2) <= y - IZR k * PI <= PI / 2) by (rewrite Y; nra).
    pose proof (sin_sqr_shift (y - IZR k * PI) k) as S.
    replace (y - IZR k * PI + IZR k * PI) with y in S by ring.
    destruct (Near _ Z) as [B _]; lra.
  - intros [k K]; pose proof (sin_sqr_shift (y - IZR k * PI) k) as S.
    replace (y - IZR k * PI + IZR k * PI) with y in S by ring; rewrite S; apply Near; lra.
Qed.

Theorem respa_window p h1 L1 h2 L2 th :
  0 < h1 -> 0 < th < PI -> h1 * h1 * L1 = 2 - 2 * cos th ->
  let alpha := h1 * h2 * L2 / (2 * sin th) in
  0 < alpha ->
  2 < Rabs (tr (respa p h1 L1 h2 L2)) <->
  exists k, IZR k * PI - 2 * atan alpha < INR p * th < IZR k * PI.
Proof.
  intros H T E alpha A; rewrite (respa_trace h1 L1 th H T E); fold alpha.
  set (x := INR p * th); set (d := atan alpha).
  assert (D : 0 < d < PI / 2).
  { split; [rewrite <- atan_0; apply atan_increasing; assumption | apply atan_bound]. }
  assert (C : 0 < cos d) by (apply cos_gt_0; lra).
  assert (S : alpha * cos d = sin d) by (rewrite <- (tan_atan alpha); fold d; unfold tan; field; lra).
  pose proof (sin2_cos2 d) as S2; pose proof (sin2_cos2 (x + d)) as S2'; unfold Rsqr in S2, S2'.
  set (t := 2 * (cos x - alpha * sin x)).
  assert (Tr : t * cos d = 2 * cos (x + d)).
  { rewrite cos_plus; unfold t; transitivity (2 * (cos x * cos d - sin x * (alpha * cos d))); [ring | rewrite S; ring]. }
  assert (X : 2 < Rabs t <-> sin (x + d) * sin (x + d) < sin d * sin d).
  { assert (Y : 4 < t * t <-> 2 < Rabs t) by (unfold Rabs; destruct Rcase_abs; split; nra).
    assert (Z : t * t * (cos d * cos d) = 4 * (cos (x + d) * cos (x + d)))
      by (transitivity (t * cos d * (t * cos d)); [ring | rewrite Tr; ring]).
    assert (0 < cos d * cos d) by nra.
    rewrite <- Y; split; intros B.
    - assert (4 * (cos d * cos d) < t * t * (cos d * cos d)) by (apply Rmult_lt_compat_r; assumption); lra.
    - apply Rmult_lt_reg_r with (cos d * cos d); [assumption | lra]. }
  rewrite X, (near_multiple (x + d) d D); split; intros [k K]; exists k; lra.
Qed.
