(** * Where no tongue closes: q = 1 and q = 2

    At a closing B = C = 0 or A = D = 0, so Q = I or Q = -I. Both clocks in action, neither with one slow kick a period nor
    with two is there any, for whatever stiffnesses, negative ones and steps beyond the Verlet limit included.

    - [no_closing_q1]   q = 1, every p;  [no_closing_p1]   p = 1, every q;
    - [no_closing_q2]   q = 2, p odd;    [no_closing_p2]   p = 2, q odd.                              *)

From Kickdrift Require Import Vocabulary Algebra TwoClocks Stability Floquet TanCriterion Respa.
From Coq Require Import Reals Arith Lia Lra Psatz.
Open Scope R_scope.

(** ** q = 1: between half slow kicks stands a power of one fast step *)

(** Cayley and Hamilton: every power of M is a M + b. *)
Lemma power_is_linear M n : det M = 1 ->
  exists a b, power M n = Mat (a * mA M + b) (a * mB M) (a * mC M) (a * mD M + b).
Proof.
  unfold det; intros D; induction n as [|n (a & b & IH)].
  - exists 0, 1; simpl; apply mat_ext; simpl; ring.
  - exists (a * tr M + b), (- a * (mA M * mD M - mB M * mC M)); simpl; rewrite IH; unfold tr.
    apply mat_ext; simpl; ring.
Qed.

Lemma power_det M n : det M = 1 -> det (power M n) = 1.
Proof.
  intros D; induction n as [|n IH]; [unfold det; simpl; ring|].
  simpl; rewrite det_mul, D, IH; ring.
Qed.

Theorem no_closing_q1 p h1 L1 h2 L2 :
  (1 <= p)%nat -> h1 <> 0 -> h2 * L2 <> 0 ->
  full_period p 1 h1 L1 h2 L2 <> one /\ full_period p 1 h1 L1 h2 L2 <> opp one.
Proof.
  intros P H K; rewrite respa_two_clocks by assumption; unfold respa.
  assert (D : det (verlet_matrix h1 L1) = 1) by (rewrite verlet_entries; unfold det; simpl; field).
  destruct (power_is_linear (verlet_matrix h1 L1) p D) as (a & b & E).
  pose proof (power_det (verlet_matrix h1 L1) p D) as D'.
  rewrite E in D' |- *; rewrite verlet_entries in D' |- *; unfold det in D'; simpl in D'.
  set (k := h2 * L2) in *.
  assert (Z : a * h1 = 0 -> a = 0) by (intros Z; apply Rmult_integral in Z; tauto).
  split; intros Q; injection Q; simpl; intros Q22 Q21 Q12 Q11.
  - assert (A : a = 0) by (apply Z; lra); subst a; nra.
  - assert (A : a = 0) by (apply Z; lra); subst a; nra.
Qed.

(** ** q = 2: between half slow kicks stand the fast clock's even and odd solution, in the middle of a drift *)

Lemma middle s r :
  Cn s (S r) - Cn s r = - (s / 2) * (Sn s r + Sn s (S r)) /\
  Cn s r + Cn s (S r) = 2 * (1 - s / 4) * (Sn s (S r) - Sn s r).
Proof.
  induction r as [|r [IH IH']].
  - unfold Cn, Sn; simpl; split; field.
  - rewrite Cn_step, Sn_step; split; nra.
Qed.

Lemma gather_two s p r k : p = (2 * r + 1)%nat ->
  kick (- (base s 2 (p * 2) / 2)) ** W s (p * 2 / 4) (INR ((p * 2) mod 4) / 4) ** updates s 2 (slow_kicks p k) (p * 2)
  = kick (k / 2) ** W s r (1 / 2) ** kick (k / 2).
Proof.
  intros R; destruct (E_at_start s 2 ltac:(lia)) as [E O].
  assert (B : base s 2 (p * 2) = 0).
  { unfold base; rewrite strikes_middle by lia.
    replace (Nat.even p) with false; [reflexivity|].
    symmetry; apply Bool.not_true_iff_false; intros V; apply Nat.even_spec in V; destruct V; lia. }
  assert (D : (p * 2 / 4 = r)%nat) by (symmetry; apply (Nat.div_unique _ _ _ 2); lia).
  assert (M : ((p * 2) mod 4 = 2)%nat) by (symmetry; apply (Nat.mod_unique _ _ r); lia).
  assert (Up : updates s 2 (slow_kicks p k) (p * 2) = update (k / 2) (even s r (1 / 2)) (odd s r (1 / 2)) ** update (k / 2) 1 0).
  { replace (p * 2)%nat with (S (S (2 * p - 2))) at 1 by lia.
    rewrite updates_succ.
    rewrite updates_first by (intros; apply slow_between; lia).
    rewrite (slow_between p k (S (2 * p - 2))), slow_start, E, O by lia.
    replace (S (S (2 * p - 2))) with (p * 2)%nat by lia.
    replace (slow_kicks p k (p * 2)) with k.
    2: { unfold slow_kicks, strikes; rewrite Nat.add_0_r, (Nat.mul_comm p 2), Nat.mod_same by lia; reflexivity. }
    unfold E_at, O_at; replace (2 * 2)%nat with 4%nat by lia; rewrite D, M.
    replace (INR 2 / (2 * INR 2)) with (1 / 2) by (simpl; field).
    replace (0 / 2) with 0 by field; now rewrite update_zero, mul_one_r. }
  rewrite Up, B, D, M; replace (INR 2 / 4) with (1 / 2) by (simpl; field).
  replace (- (0 / 2)) with 0 by field; rewrite kick_zero, mul_one_l, mul_assoc, <- update_kick.
  f_equal; apply mat_ext; simpl; ring.
Qed.

Theorem no_closing_q2 p h1 L1 h2 L2 :
  Nat.Odd p -> h1 <> 0 -> L1 <> 0 -> h2 * L2 <> 0 ->
  let H := half_period p 2 h1 L1 h2 L2 in
  ~ (mB H = 0 /\ mC H = 0) /\ ~ (mA H = 0 /\ mD H = 0).
Proof.
  intros [r R] H1 L K H.
  set (s := h1 * h1 * L1); set (k := h1 * h2 * L2).
  assert (Ks : k <> 0) by (unfold k; rewrite Rmult_assoc; now apply Rmult_integral_contrapositive_currified).
  assert (Sz : s <> 0) by (unfold s; repeat apply Rmult_integral_contrapositive_currified; assumption).
  pose proof (half_period_unit p 2 h1 L1 h2 L2 H1 ltac:(lia)) as U; fold H s k in U.
  rewrite (foreign_ticks s 2 (slow_kicks p k) ltac:(lia)) in U.
  replace (2 * 2)%nat with 4%nat in U by lia; replace (2 * INR 2) with 4 in U by (simpl; ring).
  rewrite (gather_two s p r k R) in U.
  pose proof (wronskian s r (1 / 2)) as Dt; destruct (middle s r) as [M1 M2].
  unfold W, even, odd, det in *; simpl in Dt.
  set (c0 := Cn s r) in *; set (c1 := Cn s (S r)) in *; set (s0 := Sn s r) in *; set (s1 := Sn s (S r)) in *.
  assert (f := f_equal mA U); assert (g := f_equal mB U); assert (h := f_equal mC U); assert (i := f_equal mD U).
  simpl in f, g, h, i; clear U.
  set (x := s1 - s0) in *; set (y := (s0 + s1) / 2).
  assert (Ey : (1 - 1 / 2) * s0 + 1 / 2 * s1 = y) by (unfold y; field).
  assert (Ex : (1 - 1 / 2) * c0 + 1 / 2 * c1 = (1 - s / 4) * x) by lra.
  assert (Ez : c1 - c0 = - s * y) by (unfold y; lra).
  rewrite ?Ey, ?Ex, ?Ez in Dt, f, g, h, i; clear Ey Ex Ez M1 M2; clearbody x y s k.
  split; intros [Z Z'].
  - rewrite Z in g; rewrite Z' in h.
    assert (Y : y = 0) by nra; subst y.
    assert (N : (1 - s / 4) * (x * x) = 1) by nra.
    assert (X : k * (x * (2 - s / 4)) = 0) by nra.
    assert (V : 0 < 1 - s / 4).
    { pose proof (Rle_0_sqr x) as Sq; unfold Rsqr in Sq; destruct (Rlt_le_dec 0 (1 - s / 4)) as [V|V]; [assumption | nra]. }
    apply Rmult_integral in X; destruct X as [X|X]; [contradiction|].
    apply Rmult_integral in X; destruct X as [X|X]; [subst x; lra | lra].
  - rewrite Z in f; rewrite Z' in i.
    assert (V : s * x = 0) by lra.
    apply Rmult_integral in V; destruct V as [V|V]; [contradiction|]; subst x.
    assert (Y : k * y = 0) by lra.
    apply Rmult_integral in Y; destruct Y as [Y|Y]; [contradiction | subst y; lra].
Qed.

(** ** p = 1 and p = 2: the clocks exchange their names *)

Theorem no_closing_p1 q h1 L1 h2 L2 :
  (1 <= q)%nat -> h1 = INR q * h2 -> h2 <> 0 -> h1 * L1 <> 0 ->
  full_period 1 q h1 L1 h2 L2 <> one /\ full_period 1 q h1 L1 h2 L2 <> opp one.
Proof.
  intros Q E H K; rewrite <- (swap_clocks 1 q) by (auto; simpl; lra); now apply no_closing_q1.
Qed.

Theorem no_closing_p2 q h1 L1 h2 L2 :
  Nat.Odd q -> 2 * h1 = INR q * h2 -> h2 <> 0 -> L2 <> 0 -> h1 * L1 <> 0 ->
  let H := half_period 2 q h1 L1 h2 L2 in
  ~ (mB H = 0 /\ mC H = 0) /\ ~ (mA H = 0 /\ mD H = 0).
Proof.
  intros O E H L K.
  assert (Q : (1 <= q)%nat) by (destruct O; lia).
  assert (S : half_period 2 q h1 L1 h2 L2 = half_period q 2 h2 L2 h1 L1).
  { unfold half_period; rewrite (tick_slow 2 q h1 h2), (Nat.mul_comm q 2) by (auto; simpl; lra).
    f_equal; apply schedule_ext; intros j _; unfold two_clocks; ring. }
  rewrite S; now apply no_closing_q2.
Qed.
