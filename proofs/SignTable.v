(** * The four-sign table

    - [four_signs]         the seven rows, as equivalences: the row of H says how Q = mirror H ** H behaves;
    - [row_total], [row_unique]
                           each half period lies in exactly one row;
    - [multiplier_plus], [multiplier_minus]
                           ln mu = 2 arcsinh sqrt (BC), or 2 arcsinh sqrt (-AD): growth without cancellation;
    - [symmetric_verdict]  the verdict on any time-symmetric kicks is a row of the half period;
    - [two_clocks_verdict] ... for example of two clocks;
    - [staggered_bounded]  the event loop (Algorithm 1) and the symmetric form are stable together.   *)

From Kickdrift Require Import Vocabulary Algebra TwoClocks Stability.
From Coq Require Import Reals Lra Lia Psatz.
Open Scope R_scope.

(** ** Seven rows *)

Lemma row_total H : exists k, row k H.
Proof.
  destruct (Rtotal_order (mB H * mC H) 0) as [BC|[BC|BC]].
  - destruct (Rtotal_order (mA H * mD H) 0) as [AD|[AD|AD]].
    + exists (Hyperbolic Minus); exact AD.
    + destruct (Req_dec (mA H) 0), (Req_dec (mD H) 0).
      * exists (Coexistence Minus); simpl; tauto.
      * exists (Parabolic Minus); simpl; tauto.
      * exists (Parabolic Minus); simpl; tauto.
      * nra.
    + exists Elliptic; simpl; lra.
  - destruct (Req_dec (mB H) 0), (Req_dec (mC H) 0).
    + exists (Coexistence Plus); simpl; tauto.
    + exists (Parabolic Plus); simpl; tauto.
    + exists (Parabolic Plus); simpl; tauto.
    + nra.
  - exists (Hyperbolic Plus); exact BC.
Qed.

Lemma behaves_unique k k' Q : behaves k Q -> behaves k' Q -> k = k'.
Proof.
  destruct k as [|[]|[]|[]], k' as [|[]|[]|[]]; simpl; intros [A B] [A' B']; try reflexivity; exfalso;
    try (rewrite A in A'); try (rewrite A' in A); unfold tr in *; simpl in *;
    first [lra | now apply linear_unbounded in B | now apply linear_unbounded in B' | injection A'; lra].
Qed.

Lemma factor_zero x y : x * y + y * x = 0 -> y <> 0 -> x = 0.
Proof. intros E N; apply Rmult_eq_reg_r with y; lra. Qed.

Lemma row_behaves k H : det H = 1 -> row k H -> behaves k (mirror H ** H).
Proof.
  intros D; set (Q := mirror H ** H).
  assert (DQ : det Q = 1) by (unfold Q, det in *; simpl; nra).
  assert (T1 : tr Q - 2 = 4 * (mB H * mC H)) by (unfold Q, tr, det in *; simpl; nra).
  assert (T2 : tr Q + 2 = 4 * (mA H * mD H)) by (unfold Q, tr, det in *; simpl; nra).
  destruct k as [|[]|[]|[]]; simpl; intros R.
  - assert (T : -2 < tr Q < 2) by lra; split; [exact T | now apply elliptic].
  - assert (T : 2 < tr Q) by lra; split; [exact T | apply hyperbolic; [assumption | rewrite Rabs_pos_eq; lra]].
  - assert (T : tr Q < -2) by lra; split; [exact T | apply hyperbolic; [assumption | rewrite Rabs_left; lra]].
  - assert (T : tr Q = 2) by (destruct R as [[R _]|[_ R]]; rewrite R in T1; lra).
    split; [exact T | apply parabolic; [assumption | rewrite Rabs_pos_eq; lra | | ]]; intros E.
    + unfold Q in E; injection E; intros _ C B _; unfold det in D; destruct R as [[R N]|[N R]]; rewrite R in *.
      * assert (Z := factor_zero (mA H) (mC H)); rewrite Z in D; lra.
      * assert (Z := factor_zero (mD H) (mB H)); rewrite Z in D; lra.
    + rewrite E in T; unfold tr in T; simpl in T; lra.
  - assert (T : tr Q = -2) by (destruct R as [[R _]|[_ R]]; rewrite R in T2; lra).
    split; [exact T | apply parabolic; [assumption | rewrite Rabs_left; lra | | ]]; intros E.
    + rewrite E in T; unfold tr in T; simpl in T; lra.
    + unfold Q in E; injection E; intros _ C B _; unfold det in D; destruct R as [[R N]|[N R]]; rewrite R in *.
      * assert (Z := factor_zero (mB H) (mD H)); rewrite Z in D; lra.
      * assert (Z := factor_zero (mC H) (mA H)); rewrite Z in D; lra.
  - assert (E : Q = one); [|split; [exact E | rewrite E; exact bounded_one]].
    destruct R as [B C]; unfold Q, det in *; apply mat_ext; simpl; rewrite B, C in *; lra.
  - assert (E : Q = opp one); [|split; [exact E | rewrite E; apply bounded_opp; exact bounded_one]].
    destruct R as [A C]; unfold Q, det in *; apply mat_ext; simpl; rewrite A, C in *; lra.
Qed.

Theorem four_signs k H : det H = 1 -> row k H <-> behaves k (mirror H ** H).
Proof.
  intros D; split; [now apply row_behaves|]; intros B.
  destruct (row_total H) as [k' R].
  now rewrite (behaves_unique k k' _ B (row_behaves k' H D R)).
Qed.

Theorem row_unique k k' H : det H = 1 -> row k H -> row k' H -> k = k'.
Proof. intros D R R'; apply (behaves_unique k k' (mirror H ** H)); now apply row_behaves. Qed.

(** ** The multiplier from the half period *)

Lemma ln_multiplier z : 0 < z -> ln ((2 + 4 * z + sqrt ((2 + 4 * z) * (2 + 4 * z) - 4)) / 2) = 2 * arcsinh (sqrt z).
Proof.
  intros Z; pose proof (sqrt_pos z); pose proof (sqrt_pos (1 + z)).
  pose proof (sqrt_sqrt z ltac:(lra)) as S; pose proof (sqrt_sqrt (1 + z) ltac:(lra)) as S1.
  assert (E : sqrt ((2 + 4 * z) * (2 + 4 * z) - 4) = 4 * (sqrt z * sqrt (1 + z))).
  { apply sqrt_lem_1; [nra | nra |].
    transitivity (16 * (sqrt z * sqrt z) * (sqrt (1 + z) * sqrt (1 + z))); [ring | rewrite S, S1; ring]. }
  unfold arcsinh; replace (sqrt z ^ 2 + 1) with (1 + z) by (simpl; rewrite Rmult_1_r, S; ring).
  assert (P : 0 < sqrt (1 + z)) by (apply sqrt_lt_R0; lra).
  replace (2 * ln (sqrt z + sqrt (1 + z))) with (ln (sqrt z + sqrt (1 + z)) + ln (sqrt z + sqrt (1 + z))) by ring.
  rewrite <- ln_mult by lra; f_equal; rewrite E; nra.
Qed.

Theorem multiplier_plus H :
  det H = 1 -> 0 < mB H * mC H -> ln (multiplier (mirror H ** H)) = 2 * arcsinh (sqrt (mB H * mC H)).
Proof.
  intros D P; rewrite <- ln_multiplier by exact P; unfold multiplier.
  replace (tr (mirror H ** H)) with (2 + 4 * (mB H * mC H)) by (unfold tr, det in *; simpl; lra).
  rewrite Rabs_pos_eq by lra; reflexivity.
Qed.

Theorem multiplier_minus H :
  det H = 1 -> mA H * mD H < 0 -> ln (multiplier (mirror H ** H)) = 2 * arcsinh (sqrt (- (mA H * mD H))).
Proof.
  intros D P; rewrite <- ln_multiplier by lra; unfold multiplier.
  replace (tr (mirror H ** H)) with (- (2 + 4 * - (mA H * mD H))) by (unfold tr, det in *; simpl; lra).
  rewrite Rabs_Ropp, Rmult_opp_opp, Rabs_pos_eq by lra; reflexivity.
Qed.

(** ** Two clocks *)

(** Any kicks that are symmetric in time: several clocks, phases 0 and 1/2, ... *)
Theorem symmetric_verdict k f d n :
  (forall j, (j <= 2 * n)%nat -> f (2 * n - j)%nat = f j) ->
  behaves k (propagator (schedule f d (2 * n))) <-> row k (propagator (schedule f d n)).
Proof.
  intros S; rewrite palindrome_schedule by exact S.
  destruct (palindrome (schedule f d n)) as [-> _].
  symmetry; apply four_signs, det_propagator.
Qed.

Theorem two_clocks_verdict k p q h1 L1 h2 L2 :
  (1 <= p)%nat -> (1 <= q)%nat ->
  behaves k (full_period p q h1 L1 h2 L2) <-> row k (half_period p q h1 L1 h2 L2).
Proof.
  intros P Q; destruct (full_period_mirror p q h1 L1 h2 L2 P Q) as (D & -> & _).
  symmetry; now apply four_signs.
Qed.

(** The event loop's product and the symmetric one are stable together. *)
Theorem staggered_bounded f d n :
  f n = f O -> bounded_powers (propagator (staggered f d n)) <-> bounded_powers (propagator (schedule f d n)).
Proof.
  intros E; rewrite !bounded_iff, (staggered_trace f d n E) by apply det_propagator.
  pose proof (staggered_conjugate f d n) as C; rewrite E in C; set (h := f O / 2) in *.
  assert (I : forall M N X, kick h ** M = N ** kick h -> kick h ** X = X ** kick h -> (M = X <-> N = X)).
  { intros M N X MN XX; split; intros ->.
    - transitivity (N ** kick h ** kick (- h)); [rewrite <- mul_assoc, kick_add, Rplus_opp_r, kick_zero; now rewrite mul_one_r|].
      now rewrite <- MN, XX, <- mul_assoc, kick_add, Rplus_opp_r, kick_zero, mul_one_r.
    - transitivity (kick (- h) ** (kick h ** M)); [rewrite mul_assoc, kick_add, Rplus_opp_l, kick_zero; now rewrite mul_one_l|].
      now rewrite MN, <- XX, mul_assoc, kick_add, Rplus_opp_l, kick_zero, mul_one_l. }
  rewrite (I _ _ one C), (I _ _ (opp one) C) by matrix_ring; reflexivity.
Qed.
