(** * The tan criterion, for every q

    With s = h1^2 L1 = 2 - 2 cos th, 0 < th < pi, the base chain of Floquet.v is trigonometric and
    phi = p th / 2 is its phase over half a period. Let G be the product of the updates of the slow kicks
    (halves at 0 and T/2) in the coordinates (c_E, c_O = d / sin th), a 2 x 2 matrix of determinant 1. Then
    the four entries of the half period have the signs of the four linear forms

        A' = G_A cos phi + G_C sin phi        B' = G_B cos phi + G_D sin phi
        C' = G_C cos phi - G_A sin phi        D' = G_D cos phi - G_B sin phi

    - [angle]              0 < s < 4 has such an angle;
    - [cosines], [sines]   C_n = cos (n th), S_n sin th = sin (n th);
    - [trig_update]        the update in (c_E, c_O): beta = k / sin th;
    - [four_forms]         the statement above;
    - [tan_criterion]      in t = tan phi, and at the poles cos phi = 0;
    - [tan_criterion_q1]   q = 1, as the paper states it for r-RESPA;
    - [tan_criterion_q2]   q = 2.                                                                  *)

From Kickdrift Require Import Vocabulary Algebra TwoClocks Stability Floquet.
From Coq Require Import Reals Arith Lia Lra Psatz.
Open Scope R_scope.

Theorem angle s : 0 < s < 4 -> exists th, 0 < th < PI /\ s = 2 - 2 * cos th.
Proof.
  intros S; exists (acos (1 - s / 2)); split; [apply acos_bound_lt; lra|].
  rewrite cos_acos; lra.
Qed.

Section Angle.
Variables (s th : R).
Hypothesis s_th : s = 2 - 2 * cos th.

Lemma cos_step x : cos (x + th + th) = (2 - s) * cos (x + th) - cos x.
Proof.
  assert (E : cos x = cos (x + th - th)) by (f_equal; ring).
  rewrite E, s_th, cos_plus, cos_minus; ring.
Qed.

Lemma sin_step x : sin (x + th + th) = (2 - s) * sin (x + th) - sin x.
Proof.
  assert (E : sin x = sin (x + th - th)) by (f_equal; ring).
  rewrite E, s_th, sin_plus, sin_minus; ring.
Qed.

Lemma INR_succ_mul n : INR (S n) * th = INR n * th + th.
Proof. rewrite S_INR; ring. Qed.

Theorem cosines n : Cn s n = cos (INR n * th).
Proof.
  enough (H : Cn s n = cos (INR n * th) /\ Cn s (S n) = cos (INR (S n) * th)) by tauto.
  induction n as [|n [H1 H2]].
  - unfold Cn; simpl; rewrite Rmult_0_l, Rmult_1_l, cos_0, s_th; split; field.
  - split; [exact H2|]. rewrite Cn_step, H1, H2, !INR_succ_mul, cos_step; reflexivity.
Qed.

Theorem sines n : Sn s n * sin th = sin (INR n * th).
Proof.
  enough (H : Sn s n * sin th = sin (INR n * th) /\ Sn s (S n) * sin th = sin (INR (S n) * th)) by tauto.
  induction n as [|n [H1 H2]].
  - unfold Sn; simpl; rewrite !Rmult_0_l, !Rmult_1_l, sin_0; split; ring.
  - split; [exact H2|]. rewrite Sn_step, Rmult_minus_distr_r, Rmult_assoc, H1, H2, !INR_succ_mul, sin_step; reflexivity.
Qed.

Hypothesis th_range : 0 < th < PI.

Lemma sin_pos : 0 < sin th.
Proof. apply sin_gt_0; lra. Qed.

Lemma cos_half_pos : 0 < cos (th / 2).
Proof. apply cos_gt_0; lra. Qed.

Theorem trig_update k e o : rescale (sin th) (update k e o) = update (k / sin th) e (sin th * o).
Proof. pose proof sin_pos; apply mat_ext; simpl; field; lra. Qed.

Lemma Sn_div n : Sn s n = sin (INR n * th) / sin th.
Proof. rewrite <- sines; pose proof sin_pos; field; lra. Qed.

(** ** The base chain at T/2 *)

Definition base_at_half (p q : nat) :=
  kick (- (base s q (p * q) / 2)) ** W s (p * q / (2 * q)) (INR ((p * q) mod (2 * q)) / (2 * INR q)).

Lemma base_at_half_spec p q :
  (1 <= q)%nat ->
  let phi := INR p * th / 2 in
  exists c, 0 < c /\
    base_at_half p q = Mat (c * cos phi) (c * (sin phi / sin th)) (- (sin th / c * sin phi)) (cos phi / c).
Proof.
  intros Q phi; assert (Qr : 0 < INR q) by (apply lt_0_INR; lia).
  pose proof sin_pos as SP; pose proof cos_half_pos as CP.
  unfold base_at_half, base; rewrite strikes_middle by assumption.
  destruct (Nat.Even_or_Odd p) as [[r P]|[r P]].
  - exists 1; split; [lra|].
    replace (Nat.even p) with true by (symmetry; apply Nat.even_spec; now exists r).
    replace ((p * q) mod (2 * q))%nat with O by (apply (Nat.mod_unique _ _ r); nia).
    replace (p * q / (2 * q))%nat with r by (apply (Nat.div_unique _ _ _ 0); nia).
    assert (F : phi = INR r * th) by (unfold phi; rewrite P, mult_INR; simpl; field).
    unfold W, Floquet.even, odd; rewrite !cosines, !Sn_div, !INR_succ_mul, <- F, cos_plus, sin_plus.
    apply mat_ext; simpl; rewrite ?s_th; field; lra.
  - exists (cos (th / 2)); split; [assumption|].
    replace (Nat.even p) with false by (symmetry; rewrite <- Nat.negb_odd;
      replace (Nat.odd p) with true by (symmetry; apply Nat.odd_spec; now exists r); reflexivity).
    replace ((p * q) mod (2 * q))%nat with q by (apply (Nat.mod_unique _ _ r); nia).
    replace (p * q / (2 * q))%nat with r by (apply (Nat.div_unique _ _ _ q); nia).
    assert (F : INR r * th = phi - th / 2) by (unfold phi; rewrite P, plus_INR, mult_INR; simpl; field).
    assert (F' : INR r * th + th = phi + th / 2) by (rewrite F; field).
    assert (S2 : sin th = 2 * sin (th / 2) * cos (th / 2)).
    { rewrite <- sin_2a; f_equal; field. }
    assert (S2' : 0 < sin (th / 2)) by (apply sin_gt_0; lra).
    replace (INR q / (2 * INR q)) with (1 / 2) by (field; lra).
    unfold W, Floquet.even, odd; rewrite !cosines, !Sn_div, !INR_succ_mul, F', F, cos_plus, cos_minus, sin_plus, sin_minus, S2.
    apply mat_ext; simpl; field; lra.
Qed.
End Angle.

(** ** The half period of two clocks *)

Definition slow_kicks (p : nat) (k : R) (j : nat) := if strikes p false j then k else 0.

Lemma half_period_unit p q h1 L1 h2 L2 :
  h1 <> 0 -> (1 <= q)%nat ->
  rescale (/ h1) (half_period p q h1 L1 h2 L2) =
  propagator (schedule (fun j => base (h1 * h1 * L1) q j + slow_kicks p (h1 * h2 * L2) j) (1 / (2 * INR q)) (p * q)).
Proof.
  intros H Q; assert (Qr : 0 < INR q) by (apply lt_0_INR; lia).
  unfold half_period; rewrite <- scaling by (now apply Rinv_neq_0_compat).
  f_equal; replace (tick q h1 * / h1) with (1 / (2 * INR q)) by (unfold tick; field; lra).
  apply schedule_ext; intros j _; unfold two_clocks, base, slow_kicks.
  destruct (strikes q false j), (strikes p false j); field; assumption.
Qed.

Section TwoClocksTan.
Variables (p q : nat) (h1 L1 h2 L2 th : R).
Hypotheses (p_pos : (1 <= p)%nat) (q_pos : (1 <= q)%nat) (h1_pos : 0 < h1).
Hypotheses (th_range : 0 < th < PI) (s_th : h1 * h1 * L1 = 2 - 2 * cos th).

Let phi := INR p * th / 2.
Let slow := slow_kicks p (h1 * h2 * L2).
Let H := half_period p q h1 L1 h2 L2.
Let Q := full_period p q h1 L1 h2 L2.

(** The slow clock's updates over the half period in the coordinates (c_E, c_O). *)
Definition gather := rescale (sin th) (updates (h1 * h1 * L1) q slow (p * q)).

Definition formA := mA gather * cos phi + mC gather * sin phi.
Definition formB := mB gather * cos phi + mD gather * sin phi.
Definition formC := mC gather * cos phi - mA gather * sin phi.
Definition formD := mD gather * cos phi - mB gather * sin phi.

Theorem four_forms :
  exists x y, 0 < x /\ 0 < y /\
    mA H = x * formA /\ mB H = y * formB /\ mC H = formC / y /\ mD H = formD / x.
Proof.
  pose proof (sin_pos th th_range) as SP.
  destruct (base_at_half_spec _ th s_th th_range p q q_pos) as (c & C & E); fold phi in E.
  pose proof (half_period_unit p q h1 L1 h2 L2 ltac:(lra) q_pos) as U; fold H slow in U.
  pose proof (foreign_ticks (h1 * h1 * L1) q slow q_pos (p * q)) as F.
  unfold slow in F, U; rewrite F in U; fold (base_at_half (h1 * h1 * L1) p q) slow in U; rewrite E in U; clear F E.
  assert (EH : H = rescale h1 (rescale (/ h1) H)) by (apply mat_ext; simpl; field; lra).
  rewrite U in EH; rewrite EH; exists c, (h1 * c / sin th).
  unfold formA, formB, formC, formD, gather.
  split; [assumption|]; split; [apply Rdiv_lt_0_compat; nra|].
  repeat split; simpl; field; lra.
Qed.

Corollary forms_products : mA H * mD H = formA * formD /\ mB H * mC H = formB * formC.
Proof.
  destruct four_forms as (x & y & X & Y & -> & -> & -> & ->); split; field; lra.
Qed.

Corollary forms_traces : tr Q - 2 = 4 * (formB * formC) /\ tr Q + 2 = 4 * (formA * formD).
Proof.
  destruct forms_products as [<- <-].
  now destruct (full_period_mirror p q h1 L1 h2 L2 p_pos q_pos) as (_ & _ & E).
Qed.

Lemma scaled_sign c x y : c <> 0 -> x = c * c * y -> (0 < x <-> 0 < y) /\ (x < 0 <-> y < 0).
Proof. intros N ->; assert (0 < c * c) by nra; split; split; nra. Qed.

Theorem tan_criterion :
  let t := tan phi in
  (cos phi <> 0 ->
     (2 < tr Q  <-> 0 < (mB gather + mD gather * t) * (mC gather - mA gather * t)) /\
     (tr Q < -2 <-> (mA gather + mC gather * t) * (mD gather - mB gather * t) < 0)) /\
  (cos phi = 0 ->
     (2 < tr Q  <-> mA gather * mD gather < 0) /\
     (tr Q < -2 <-> 0 < mB gather * mC gather)).
Proof.
  intros t; destruct forms_traces as [T1 T2]; split; intros N.
  - destruct (scaled_sign (cos phi) (formB * formC)
      ((mB gather + mD gather * t) * (mC gather - mA gather * t)) N) as [P _].
    { unfold formB, formC, t, tan; field; exact N. }
    destruct (scaled_sign (cos phi) (formA * formD)
      ((mA gather + mC gather * t) * (mD gather - mB gather * t)) N) as [_ P'].
    { unfold formA, formD, t, tan; field; exact N. }
    rewrite <- P, <- P'; split; split; lra.
  - pose proof (sin2_cos2 phi) as S; unfold Rsqr in S; rewrite N in S.
    assert (E1 : formB * formC = - (mA gather * mD gather) * (sin phi * sin phi)) by (unfold formB, formC; rewrite N; ring).
    assert (E2 : formA * formD = - (mB gather * mC gather) * (sin phi * sin phi)) by (unfold formA, formD; rewrite N; ring).
    assert (S1 : sin phi * sin phi = 1) by lra; rewrite S1 in E1, E2.
    split; split; lra.
Qed.
End TwoClocksTan.

(** ** q = 1 and q = 2 *)

Lemma updates_succ s q g i :
  updates s q g (S i) =
  update (g (S i) / 2) (E_at s q (S i)) (O_at s q (S i)) ** update (g i / 2) (E_at s q i) (O_at s q i) ** updates s q g i.
Proof. reflexivity. Qed.

Lemma updates_first s q g n :
  (forall j, (0 < j <= S n)%nat -> g j = 0) -> updates s q g (S n) = update (g O / 2) (E_at s q 0) (O_at s q 0).
Proof.
  intros Z; induction n as [|n IH]; rewrite updates_succ.
  - rewrite Z by lia; replace (0 / 2) with 0 by field; simpl; now rewrite update_zero, mul_one_l, mul_one_r.
  - rewrite !Z by lia; replace (0 / 2) with 0 by field; rewrite !update_zero, !mul_one_l.
    apply IH; intros; apply Z; lia.
Qed.

Lemma E_at_start s q : (1 <= q)%nat -> E_at s q 0 = 1 /\ O_at s q 0 = 0.
Proof.
  intros Q; assert (0 < INR q) by (apply lt_0_INR; lia).
  unfold E_at, O_at, Floquet.even, odd, Cn, Sn; rewrite Nat.mod_0_l, Nat.div_0_l by lia; simpl; split; field; lra.
Qed.

Lemma slow_start p k : (1 <= p)%nat -> slow_kicks p k 0 = k.
Proof. intros P; unfold slow_kicks, strikes; now rewrite Nat.mod_0_l by lia. Qed.

Lemma slow_between p k j : (0 < j < 2 * p)%nat -> slow_kicks p k j = 0.
Proof.
  intros J; unfold slow_kicks, strikes; rewrite Nat.add_0_r, Nat.mod_small by lia.
  destruct j; [lia | reflexivity].
Qed.

Section SmallQ.
Variables (p : nat) (h1 L1 h2 L2 th : R).
Hypotheses (p_pos : (1 <= p)%nat) (h1_pos : 0 < h1).
Hypotheses (th_range : 0 < th < PI) (s_th : h1 * h1 * L1 = 2 - 2 * cos th).
Let phi := INR p * th / 2.
Let alpha := h1 * h2 * L2 / (2 * sin th).

Lemma gather_q1 : gather p 1 h1 L1 h2 L2 th = kick alpha.
Proof.
  pose proof (sin_pos th th_range); destruct (E_at_start (h1 * h1 * L1) 1 ltac:(lia)) as [E O].
  unfold gather; replace (p * 1)%nat with (S (pred p)) by lia.
  rewrite updates_first by (intros; apply slow_between; lia).
  rewrite slow_start, E, O by assumption; apply mat_ext; simpl; unfold alpha; field; lra.
Qed.

(** Tr > 2 and Tr < -2 apart; at the poles of tan the trace is -2. *)
Theorem tan_criterion_q1_signs :
  let Q := full_period p 1 h1 L1 h2 L2 in
  let t := tan phi in
  (cos phi <> 0 -> (2 < tr Q <-> t * (t + alpha) < 0) /\ (tr Q < -2 <-> 1 < alpha * t)) /\
  (cos phi = 0 -> tr Q = -2).
Proof.
  intros Q t; destruct (tan_criterion p 1 h1 L1 h2 L2 th p_pos ltac:(lia) h1_pos th_range s_th) as [T _].
  destruct (forms_traces p 1 h1 L1 h2 L2 th p_pos ltac:(lia) h1_pos th_range s_th) as [_ T2].
  unfold formA, formD in T2; rewrite gather_q1 in T, T2; simpl in T, T2; fold phi Q in T, T2; fold t in T.
  split; intros N.
  - destruct (T N) as [-> ->]; split; split; nra.
  - rewrite N in T2; lra.
Qed.

Theorem tan_criterion_q1 :
  0 < alpha ->
  let Q := full_period p 1 h1 L1 h2 L2 in
  let t := tan phi in
  2 < Rabs (tr Q) <-> cos phi <> 0 /\ (0 < 1 / alpha < t \/ - alpha < t < 0).
Proof.
  intros A Q t; destruct tan_criterion_q1_signs as [T P]; fold Q t in T, P.
  assert (I : 0 < 1 / alpha /\ alpha * (1 / alpha) = 1) by (split; [apply Rdiv_lt_0_compat; lra | field; lra]).
  destruct (Req_dec (cos phi) 0) as [N|N].
  - rewrite (P N); replace (Rabs (-2)) with 2 by (rewrite Rabs_left; lra); split; [lra | tauto].
  - destruct (T N) as [T1 T2]; clear T P.
    assert (X : 2 < Rabs (tr Q) <-> 2 < tr Q \/ tr Q < -2) by (unfold Rabs; destruct Rcase_abs; lra).
    rewrite X, T1, T2; split; [intros [B|B]; split; try exact N | intros [_ [B|B]]].
    + right; split; nra.
    + left; split; nra.
    + right; nra.
    + left; nra.
Qed.

Hypothesis p_odd : Nat.Odd p.
Let c2 := cos (th / 2) * cos (th / 2).

Lemma gather_q2 :
  gather p 2 h1 L1 h2 L2 th = update alpha (cos (th / 2) * cos phi) (cos (th / 2) * sin phi) ** kick alpha.
Proof.
  pose proof (sin_pos th th_range) as SP; destruct (E_at_start (h1 * h1 * L1) 2 ltac:(lia)) as [E O].
  destruct p_odd as [r R].
  set (s := h1 * h1 * L1) in *; set (k := h1 * h2 * L2).
  assert (Up : updates s 2 (slow_kicks p k) (p * 2) =
    update (k / 2) (E_at s 2 (p * 2)) (O_at s 2 (p * 2)) ** update (k / 2) 1 0).
  { replace (p * 2)%nat with (S (S (2 * p - 2))) at 1 by lia.
    rewrite updates_succ.
    rewrite updates_first by (intros; apply slow_between; lia).
    rewrite (slow_between p k (S (2 * p - 2))), slow_start, E, O by lia.
    replace (S (S (2 * p - 2))) with (2 * p)%nat by lia.
    replace (slow_kicks p k (2 * p)) with k.
    2: { unfold slow_kicks, strikes; rewrite Nat.add_0_r, Nat.mod_same by lia; reflexivity. }
    replace (0 / 2) with 0 by field; now rewrite update_zero, mul_one_r, (Nat.mul_comm p 2). }
  assert (EO : E_at s 2 (p * 2) = cos (th / 2) * cos phi /\ O_at s 2 (p * 2) * sin th = cos (th / 2) * sin phi).
  { unfold E_at, O_at.
    replace (p * 2 / (2 * 2))%nat with r by (apply (Nat.div_unique _ _ _ 2); lia).
    replace ((p * 2) mod (2 * 2))%nat with 2%nat by (apply (Nat.mod_unique _ _ r); lia).
    assert (F : INR r * th = phi - th / 2) by (unfold phi; rewrite R, plus_INR, mult_INR; simpl; field).
    assert (F' : INR r * th + th = phi + th / 2) by (rewrite F; field).
    unfold Floquet.even, odd; rewrite !(cosines s th s_th).
    rewrite Rmult_plus_distr_r, !Rmult_assoc, !(sines s th s_th), !INR_succ_mul, F', F.
    rewrite cos_plus, cos_minus, sin_plus, sin_minus; split; simpl; field. }
  unfold gather; fold s k; rewrite Up; destruct EO as [-> EO].
  rewrite rescale_mul, trig_update, trig_update, (Rmult_comm (sin th)), EO, Rmult_0_r by (assumption || lra).
  unfold alpha; fold k; replace (k / 2 / sin th) with (k / (2 * sin th)) by (field; lra).
  f_equal; matrix_ring.
Qed.

Theorem tan_criterion_q2 :
  let Q := full_period p 2 h1 L1 h2 L2 in
  let t := tan phi in
  (cos phi <> 0 ->
     (2 < tr Q  <-> t * (t * (1 - alpha * alpha * c2) + alpha * (1 + c2)) < 0) /\
     (tr Q < -2 <-> (1 - alpha * t) * (1 - alpha * c2 * t) < 0)) /\
  (cos phi = 0 -> (2 < tr Q <-> 1 < alpha * alpha * c2) /\ ~ tr Q < -2).
Proof.
  intros Q t.
  destruct (forms_traces p 2 h1 L1 h2 L2 th p_pos ltac:(lia) h1_pos th_range s_th) as [T1 T2].
  unfold formA, formB, formC, formD in T1, T2; rewrite gather_q2 in T1, T2; fold phi Q in T1, T2; simpl in T1, T2.
  pose proof (sin2_cos2 phi) as S; unfold Rsqr in S.
  set (c := cos phi) in *; set (x := cos (th / 2)) in *.
  assert (X : c2 = x * x) by reflexivity; clearbody c2 x; subst c2.
  split; intros N.
  - assert (St : sin phi = t * c) by (unfold t, tan, c; field; exact N).
    rewrite St in T1, T2, S; clearbody t c.
    assert (P : tr Q - 2 = - (4 * (c * c * (t * (t * (1 - alpha * alpha * (x * x)) + alpha * (1 + x * x)))))).
    { rewrite T1; transitivity (- (4 * (c * c * (t * (t + alpha +
        (alpha * x * x - alpha * alpha * x * x * t) * (t * c * (t * c) + c * c)))))); [ring|].
      rewrite S; ring. }
    assert (P' : tr Q + 2 = 4 * (c * c * ((1 - alpha * t) * (1 - alpha * (x * x) * t)))).
    { rewrite T2; transitivity (4 * (c * c * ((1 - alpha * t) *
        (1 - alpha * x * x * t * (t * c * (t * c) + c * c))))); [ring|].
      rewrite S; ring. }
    destruct (scaled_sign c _ _ N (eq_refl (c * c * (t * (t * (1 - alpha * alpha * (x * x)) + alpha * (1 + x * x)))))) as [_ <-].
    destruct (scaled_sign c _ _ N (eq_refl (c * c * ((1 - alpha * t) * (1 - alpha * (x * x) * t))))) as [_ <-].
    split; split; lra.
  - rewrite N in T1, T2, S; set (y := sin phi) in *; clearbody c y.
    assert (P : tr Q - 2 = - (4 * (y * y * (1 - alpha * alpha * (x * x) * (y * y + 0 * 0))))) by (rewrite T1; ring).
    assert (P' : tr Q + 2 = 4 * (alpha * x * y * y * (alpha * x * y * y))) by (rewrite T2; ring).
    rewrite S in P; replace (y * y) with 1 in P by lra.
    pose proof (Rle_0_sqr (alpha * x * y * y)) as Sq; unfold Rsqr in Sq; split; [split|]; lra.
Qed.
End SmallQ.
